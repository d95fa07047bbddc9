// Lists of players who may join: the entries of a file, and the answers and effects of the command.
#include "server/admin/allow_commands.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/allow_file.hpp"
#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

using AllowEntries = std::vector<AllowEntry>;

AllowEntries entries_of(std::string_view text, bool is_csv = false) {
  const auto list = parse_allow_list(text, is_csv);
  INFO((list ? "" : list.error()));
  REQUIRE(list.has_value());
  return list->entries;
}
std::string allow_error(std::string_view text, bool is_csv = false) {
  const auto list = parse_allow_list(text, is_csv);
  return list ? "" : list.error();
}

/// A world in which two players own the names Ana and bea.
struct AllowBench : CommandBench {
  AllowBench()
      : CommandBench(config(), start()), services{bench.server,
                                                  service,
                                                  *this,
                                                  placing,
                                                  folder.path(),
                                                  {},
                                                  [](const PublicKey&) {
              return false; }} {}
  static constexpr std::uint8_t kFriends = 120;
  static PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }
  static WorldStart start() {
    WorldStart start;
    start.name_claims = {{"ana", "Ana", key_of(1)}, {"bea", "bea", key_of(2)}};
    for (std::uint8_t i = 0; i < kFriends; ++i) {
      const std::string name = "friend " + std::to_string(i);
      start.name_claims.push_back({name, name, PublicKey{i, 7}});
    }
    return start;
  }
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 6; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  /// Imports a file with this text.
  CommandAnswer import(const std::string& text, const std::string& words = "",
                       const std::string& name = "list.txt") {
    std::ofstream(folder / name) << text;
    return give({}, "allow import " + (folder / name) + words);
  }

  CommandServices services;
};

}  // namespace

TEST_CASE("names stand one a line, with comments and any ends of lines", "[admin][allow]") {
  CHECK(entries_of("ana\r\n\n# friends\n  the mole, jr. \nbea") ==
        AllowEntries{{1, "ana", ""}, {4, "the mole, jr.", ""}, {5, "bea", ""}});
  CHECK(entries_of("").empty());
}

TEST_CASE("a table has the names in a column of its own, or in the first one", "[admin][allow]") {
  CHECK(entries_of("UUID,Name,since\n1,ana,2024\n2,\"the \"\"mole\"\", jr.\",2025\n3\n", true) ==
        AllowEntries{{2, "ana", ""}, {3, "the \"mole\", jr.", ""}, {4, "", "has no name"}});
  CHECK(entries_of("ana;1\nbea ; 2\n", true) == AllowEntries{{1, "ana", ""}, {2, "bea", ""}});
}

TEST_CASE("the white list of another game is a JSON list of objects", "[admin][allow]") {
  const auto list = parse_allow_list(
      "\n[{\"uuid\": \"9b\", \"name\": \"ana\"}, {\"uuid\": \"7\"}, 5, {\"name\": 7},"
      " {\"name\": \" bea \"}]",
      false);
  REQUIRE(list.has_value());
  CHECK(list->unit == std::string("entry"));
  CHECK(list->entries == AllowEntries{{1, "ana", ""},
                                      {2, "", "has no name"},
                                      {3, "", "has no name"},
                                      {4, "", "has no name"},
                                      {5, "bea", ""}});
  CHECK(allow_error("[{\"name\": \"ana\"") == "is no valid JSON");
  CHECK(allow_error("{\"name\": \"ana\"}") == "is JSON, but no list of objects with a name");
  CHECK(allow_error(std::string(100'000, '[')) == "is no valid JSON");
}

TEST_CASE("a list has a bounded number of entries", "[admin][allow]") {
  std::string text;
  for (std::size_t i = 0; i < kAllowEntriesMax; ++i) text += "ana\n";
  CHECK(entries_of(text).size() == kAllowEntriesMax);
  CHECK(contains(allow_error(text + "bea"), "2000 entries"));
}

TEST_CASE("each name of a list is added, known or refused, and the answer says which",
          "[admin][allow]") {
  AllowBench bench;
  const CommandAnswer first = bench.import("ANA\nbert\nx\xff\n\xe2\x80\xae\n", " role visitor");
  CHECK(first.is_ok);
  CHECK(contains(first.text, ": 1 added, 0 invited, 0 already there, 3 refused\n"));
  CHECK(contains(first.text, "\nline 1 ANA: added (record 1)"));
  CHECK(contains(first.text, "\nline 2 bert: refused: nobody owns this name yet"));
  CHECK(contains(first.text, "\nline 3 "));
  const RightsState& rights = bench.bench.server.rights().state();
  CHECK(rights.role_of(AllowBench::key_of(1)).name == "visitor");
  const CommandAnswer second = bench.import("[{\"name\":\"ana\"},{\"name\":\"bea\"}]");
  CHECK(contains(second.text, ": 1 added, 0 invited, 1 already there, 0 refused\n"));
  CHECK(contains(second.text, "\nentry 1 ana: already there: the player has the role visitor"));
  CHECK(rights.role_of(AllowBench::key_of(1)).name == "visitor");
  CHECK(rights.grants().at(AllowBench::key_of(2)).value == "builder");
}

TEST_CASE("names that nobody owns get an invite if the command says so", "[admin][allow]") {
  AllowBench bench;
  const std::string text =
      bench.import("name,x\nbert,1\nBERT,2\nana,3\n", " invites", "a.CSV").text;
  CHECK(contains(text, ": 1 added, 1 invited, 1 already there, 0 refused\n"));
  CHECK(contains(text, "\nline 2 bert: invited: runstone://"));
  CHECK(contains(text, "\nline 3 BERT: already there"));
  const auto& invites = bench.bench.server.rights().state().invites();
  REQUIRE(invites.size() == 1);
  CHECK(invites.begin()->second.value.invite.uses == 1);
  CHECK(invites.begin()->second.value.invite.role == "builder");
}

TEST_CASE("a long list is taken in parts, and a banned player is refused", "[admin][allow]") {
  AllowBench bench;
  const Restrict ban{RestrictionKind::ban, AllowBench::key_of(2), 0, ""};
  REQUIRE(bench.bench.server.changes().change_rights(ban, {}, 0, bench.bench.now()));
  std::string text = "bea\n";
  for (int i = 0; i < AllowBench::kFriends; ++i) text += "friend " + std::to_string(i) + "\n";
  const std::string answer = bench.import(text).text;
  CHECK(contains(answer, ": 120 added, 0 invited, 0 already there, 1 refused\n"));
  CHECK(contains(answer, "\nline 1 bea: refused: the player is banned"));
  CHECK(bench.bench.server.rights().state().grants().size() == AllowBench::kFriends);
}

TEST_CASE("a list ends no role for some time", "[admin][allow]") {
  AllowBench bench;
  const PublicKey key = AllowBench::key_of(1);
  const TimeUs until_us = bench.bench.now().utc_us + 3'600'000'000;
  REQUIRE(bench.bench.server.changes().change_rights(GrantRole{key, "moderator", until_us}, {}, 0,
                                                     bench.bench.now()));
  const std::string answer = bench.import("ana\n").text;
  CHECK(contains(answer, "\nline 1 ana: refused: the player has the role moderator for some time"));
  CHECK(bench.bench.server.rights().state().timed_grants().contains(key));
}

TEST_CASE("only the console and control import lists, and powers are asked for", "[admin][allow]") {
  AllowBench bench;
  const PublicKey key = AllowBench::key_of(1);
  REQUIRE(bench.bench.server.changes().change_rights(GrantRole{key, "administrator"}, {}, 0,
                                                     bench.bench.now()));
  CHECK_FALSE(bench.give({0, {key, false}}, "allow import /etc/passwd").is_ok);
  CHECK_FALSE(bench.give({}, "allow import " + (bench.folder / "missing")).is_ok);
  CHECK(contains(bench.import("bea", " role nobody-knows").text, "there is no role"));
  const CommandAnswer doubted = bench.import("bea", " role moderator");
  CHECK_FALSE(doubted.is_ok);
  CHECK(contains(doubted.text, "anyway"));
  CHECK(contains(bench.import("bea", " role moderator anyway").text, "1 added"));
}

}  // namespace runstone::test
