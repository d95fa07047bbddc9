#include "server/admin/command_table.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <set>
#include <string>

#include "protocol/limits.hpp"
#include "server/admin/rollback_commands.hpp"
#include "tests/unit/server/admin/parsed_command.hpp"

namespace runstone::test {

TEST_CASE("commands without arguments are parsed", "[admin][command]") {
  CHECK(row_of("help") == "help");
  CHECK(row_of("names") == "names");
  CHECK(row_of("names release \"the mole\"") == "names release");
  CHECK(parsed<std::string>("names release \"the mole\"") == "the mole");
  CHECK(row_of("  status ") == "status");
  CHECK(row_of("players") == "players");
  CHECK(row_of("materials") == "materials");
  CHECK(parsed<std::string>("materials").empty());
  CHECK(parsed<std::string>("materials wool") == "wool");
  CHECK(row_of("materials add") == "materials");
  CHECK(parsed<std::string>("materials add") == "add");
  CHECK(row_of("materials add \"my wool.toml\"") == "materials add FILE");
  CHECK(parsed<std::string>("materials add \"my wool.toml\"") == "my wool.toml");
  CHECK(row_of("servers") == "servers");
  CHECK(row_of("handover") == "handover");
  CHECK(parsed<std::optional<SessionId>>("handover") == std::nullopt);
  CHECK(parsed<std::optional<SessionId>>("handover 17") == 17U);
  CHECK(row_of("stop") == "stop");
  CHECK(row_of("undo") == "undo");
  CHECK(row_of("redo") == "redo");
  CHECK(row_of("rollback list") == "rollback list");
}

TEST_CASE("say takes the rest of the line", "[admin][command]") {
  CHECK(parsed<std::string>("say hello") == "hello");
  CHECK(parsed<std::string>("  say  restart at 10, don't log off ") ==
        "restart at 10, don't log off");
  CHECK(parsed<std::string>("say \"restart at ten\"") == "restart at ten");
  CHECK(parsed<std::string>("say press \"home\" now") == "press \"home\" now");
  CHECK(parsed<std::string>("say \"a\" and \"b\"") == "\"a\" and \"b\"");
  CHECK(mistake("say") == "say: the text is refused: it is empty");
  CHECK(mistake("say \" \"") == "say: the text is refused: it is empty");
  CHECK(mistake("say a\xe2\x80\xae"
                "b") == "say: the text is refused: it has invisible characters");
  CHECK(mistake("say " + std::string(513, 'x')) ==
        "say: the text is refused: it has more than 512 bytes");
  CHECK(mistake("say a\nb").starts_with("say: the text is refused: it has control characters"));
  CHECK(mistake("saying") == "\"saying\" is no command: `help` names them");
}

TEST_CASE("chat log selects lines by player, age and number", "[admin][command]") {
  CHECK(parsed<ChatQuery>("chat log") == ChatQuery{});
  const auto query = parsed<ChatQuery>("chat log by \"the mole\" since 1h limit 1000");
  CHECK(query == ChatQuery{"the mole", kTypedUs - 3'600'000'000, 1'000});
  constexpr const char* kChatRule =
      "chat: log comes after it, and then by, since or limit; or withdraw PLAYER";
  CHECK(mistake("chat") == kChatRule);
  CHECK(mistake("chat hello") == kChatRule);
  CHECK(mistake("chat log of ana") == "chat log \"of\": by, since or limit");
  CHECK(mistake("chat log limit 1001") == "chat log limit \"1001\": a number from 1 to 1000");
  CHECK(mistake("chat log by") == "chat log by: a name, a fingerprint, a key or server is missing");
}

TEST_CASE("a filter selects by author, time, place and cause", "[admin][command]") {
  const auto preview = parsed<RollbackPreviewCommand>(
      "rollback preview author #3 author \"the mole\" since 1h until 2001-09-09T01:46:40Z box 5 60 "
      "-3 -4 70 8 cause player");
  CHECK_FALSE(preview.picture);
  CHECK(parsed<RollbackPreviewCommand>("rollback preview author #3 picture since 1h").picture);
  const CommandFilter& f = preview.filter;
  REQUIRE(f.authors.size() == 2);
  CHECK(f.authors[0] == CommandFilter::Author{"", 3});
  CHECK(f.authors[1] == CommandFilter::Author{"the mole", std::nullopt});
  CHECK(f.from_us == kTypedUs - 3'600'000'000);
  CHECK(f.until_us == 1'000'000'000'000'000);
  CHECK(f.box == VoxelBox{{-4, 60, -3}, {6, 71, 9}});  // both corners inside
  CHECK(f.cause == Cause::player);
  const auto log = parsed<LogCommand>("log");
  CHECK(log.limit == 20);
  CHECK(log.filter == CommandFilter{});
  CHECK(parsed<LogCommand>("log limit 7 cause undo").limit == 7);
}

TEST_CASE("a filter selects groups of players", "[admin][command]") {
  const CommandFilter f = parsed<RollbackPreviewCommand>(
                              "rollback preview author grief* not author ana not author #7 "
                              "address-of \"the mole, jr.\" joined-after 2h")
                              .filter;
  CHECK(f.authors == std::vector{CommandFilter::Author{"grief*", std::nullopt}});
  CHECK(f.not_authors ==
        std::vector{CommandFilter::Author{"ana", std::nullopt}, CommandFilter::Author{"", 7}});
  CHECK(f.address_of == std::vector<std::string>{"the mole, jr."});
  CHECK(f.joined_after_us == kTypedUs - TimeUs{7'200} * 1'000'000);
  // The last word confirms, unless it is a name.
  CHECK(command_of("rollback preview author * anyway").is_confirmed);
  CHECK_FALSE(command_of("rollback preview author anyway").is_confirmed);
  CHECK_FALSE(command_of("rollback preview not author anyway").is_confirmed);
  CHECK_FALSE(command_of("rollback preview address-of anyway").is_confirmed);
}

TEST_CASE("a line has a bounded number of patterns of names", "[admin][command]") {
  std::string line = "rollback preview not author z*";
  for (std::size_t i = 1; i < kPatternsMax; ++i) line += " author a*";
  CHECK(mistake(line) == "no mistake");
  CHECK(mistake(line + " author ana") == "no mistake");
  CHECK(mistake(line + " author b*") ==
        "rollback preview author \"b*\": a line has at most 8 patterns of names");
  CHECK(mistake(line + " not author b*") ==
        "rollback preview author \"b*\": a line has at most 8 patterns of names");
}

TEST_CASE("a rollback command takes one id", "[admin][command]") {
  CHECK(row_of("rollback apply p1") == "rollback apply");
  CHECK(parsed<std::string>("rollback apply p1") == "p1");
  CHECK(row_of("rollback cancel p1") == "rollback cancel");
  CHECK(parsed<std::string>("rollback cancel p1") == "p1");
  CHECK(row_of("rollback undo 9120") == "rollback undo");
  CHECK(parsed<std::string>("rollback undo 9120") == "9120");
}

TEST_CASE("an error names the wrong word and what is allowed", "[admin][command]") {
  CHECK(mistake("") == "no command: `help` names them");
  CHECK(mistake("names free ana") == "names \"free\": release NAME");
  CHECK(mistake("names release the mole") ==
        "names release: one name comes after it, in quotes if it has blanks");
  for (const char* wrong : {"handover ana", "handover -1", "handover 4294967296", "handover 1 2"}) {
    CHECK(mistake(wrong) ==
          "handover: the number of one server comes after it, or nothing (servers lists them)");
  }
  CHECK(mistake("servers all") == "servers \"all\": nothing comes after servers");
  CHECK(mistake("rolback") == "\"rolback\" is no command: `help` names them");
  CHECK(mistake("rollback") == "rollback: preview, apply, cancel, undo or list is missing");
  CHECK(mistake("rollback revert p1") ==
        "rollback \"revert\": preview, apply, cancel, undo or list");
  CHECK(mistake("rollback apply") ==
        "rollback apply: one id comes after it (rollback list names them)");
  CHECK(mistake("rollback list now") == "rollback list \"now\": nothing comes after list");
  const std::string filters =
      "author, not author, address-of, joined-after, since, until, box, in, cause";
  CHECK(mistake("rollback preview") ==
        "rollback preview: say whose edits, when, where or why: " + filters);
  CHECK(mistake("rollback preview by ana") ==
        "rollback preview \"by\": " + filters + " or picture");
  CHECK(mistake("log by ana") == "log \"by\": " + filters + " or limit");
  CHECK(mistake("rollback preview not ana") == "rollback preview not \"ana\": author PLAYER");
  CHECK(mistake("rollback preview not") == "rollback preview not: author PLAYER is missing");
  CHECK(mistake("rollback preview joined-after ever") ==
        "rollback preview joined-after \"ever\": how long ago (90s, 15m, 2h30m, 2d, "
        "1w) or when (2026-11-21T23:57:42Z, in UTC)");
  CHECK(mistake("log address-of").starts_with("log address-of: a name, # and a number"));
  CHECK(mistake("rollback preview cause rights") ==
        "rollback preview cause \"rights\": rights undo SEQ takes these records back");
  CHECK(mistake("rollback preview cause materials") ==
        "rollback preview cause \"materials\": added materials and shapes stay");
  CHECK(mistake("log since yesterday") ==
        "log since \"yesterday\": how long ago (90s, 15m, 2h30m, 2d, "
        "1w) or when (2026-11-21T23:57:42Z, in UTC)");
  CHECK(mistake("log author #x") == "log author \"#x\": a number after #, or a name");
  CHECK(mistake("log author") ==
        "log author: a name, # and a number, a key or a fingerprint, is missing");
  CHECK(
      mistake("log box 1 2 3 4 5") ==
      "log box: six numbers: x y z of one corner and of the opposite one, both inside is missing");
  CHECK(mistake("log box 1 2 3 4 5 6000000000") ==
        "log box \"6000000000\": a whole number from -536870912 to 536870911");
  CHECK(mistake("log cause rage") ==
        "log cause \"rage\": player, console, rollback, undo, redo, import, rights, materials, "
        "library, clock, textures or gap");
  CHECK(mistake("log limit 0") == "log limit \"0\": a number from 1 to 1000");
  CHECK(mistake("log \"a") == "a \" is missing at the end");
  CHECK(mistake("materials wool red") ==
        "materials \"red\": at most one word comes after materials");
  CHECK(mistake("materials add my wool.toml") ==
        "materials add: one file comes after it, in quotes if it has blanks");
  CHECK(mistake("builds") ==
        "builds: list, show, import, export, picture, place, cancel or remove is missing");
  CHECK(mistake("builds list colour red") ==
        "builds list \"colour\": name, author, tag, before or count");
  CHECK(mistake("builds list count 51") == "count \"51\": a number from 1 to 50");
  CHECK(mistake("builds import mill mill.rsb") ==
        "builds import: one file or folder comes after it, in quotes if it has blanks");
  CHECK(mistake("builds export 7 mill mill.rsb") ==
        "builds export: the number of a build and a file come after it");
  CHECK(mistake("builds place 7") ==
        "builds place: at X Y Z is missing: the place of its lowest corner");
  CHECK(mistake("builds place 7 at 1 2 3 turn 45") == "turn 45: 90, 180 or 270");
  CHECK(mistake("builds place 7 at 1 2 3 materials red") == "materials: add or nearest");
  CHECK(mistake("builds place 7 at 1 2 3 fast") ==
        "builds place \"fast\": turn, mirror, only-into, without or materials");
  CHECK(mistake("backup") == "backup: the new folder comes after it");
  CHECK(mistake("reload now") == "reload \"now\": nothing comes after reload");
  CHECK(mistake("undo it") == "undo \"it\": nothing comes after undo");
  CHECK(mistake("help\n") == "a command is printable UTF-8 text");
  CHECK(mistake(std::string(kCommandBytesMax + 1, 'a')) == "a command has at most 1024 bytes");
}

TEST_CASE("answers and filters use the same names of causes", "[admin][command]") {
  for (const Cause cause : {Cause::player, Cause::console, Cause::rollback, Cause::undo,
                            Cause::redo, Cause::import, Cause::rights, Cause::materials,
                            Cause::library, Cause::clock, Cause::textures, Cause::gap}) {
    CHECK(parsed<LogCommand>("log cause " + std::string(name_of(cause))).filter.cause == cause);
  }
}

namespace {

CommandRule rule(const std::string& line) { return command_of(line).row->rule; }

}  // namespace

TEST_CASE("each command needs its right", "[admin][rights]") {
  for (const char* line :
       {"help", "players", "materials", "roles", "protected", "why ana see", "time"})
    CHECK(rule(line).any_of == RightSet());
  for (const char* line : {"undo", "redo"}) CHECK(rule(line).any_of == RightSet{Right::undo});
  for (const char* line :
       {"claim a 0 0 0 1 1 1", "protect a 0 0 0 1 1 1", "protect a add ana", "unprotect a"}) {
    CHECK(rule(line).any_of == RightSet{Right::claim, Right::protect});
  }
  for (const char* line : {"status", "names", "kick ana", "ban ana", "mute ana", "freeze ana",
                           "unban ana", "bans", "chat log"}) {
    CHECK(rule(line).any_of == RightSet{Right::moderate});
  }
  CHECK(rule("log").any_of == RightSet{Right::roll_back});
  // Owners of protected ground take edits back there.
  for (const char* line : {"rollback list", "rollback apply p1", "rollback preview since 1h"}) {
    CHECK(rule(line).any_of == RightSet{Right::build, Right::claim, Right::roll_back});
  }
  for (const char* line : {"grant ana mason", "revoke ana", "grants"})
    CHECK(rule(line).any_of == RightSet{Right::grant});
  for (const char* line : {"role set mason see", "role remove mason", "role default mason",
                           "names release ana", "stop", "servers", "handover", "rights undo 3",
                           "password", "password clear", "say hello"}) {
    CHECK(rule(line).any_of == RightSet{Right::administer});
  }
  for (const char* line : {"backup copy", "reload", "materials add wool.toml", "password set"})
    CHECK(rule(line).is_local);
}

TEST_CASE("help lists what the caller may do", "[admin][rights]") {
  const auto lists = [](const std::string& text, const std::string& command) {
    return ("\n" + text).find("\n" + command) != std::string::npos;
  };
  const std::string none = command_help([](Right) { return false; }, false);
  CHECK(lists(none, "help "));
  CHECK(lists(none, "why PLAYER RIGHT "));
  for (const char* command :
       {"undo ", "claim ", "rollback ", "ban ", "grant ", "stop", "backup ", "FILTERS", "BOX"}) {
    CHECK_FALSE(lists(none, command));
  }
  const std::string undo = command_help([](Right right) { return right == Right::undo; }, false);
  CHECK(lists(undo, "redo "));
  CHECK_FALSE(lists(undo, "log "));
  const std::string all = command_help([](Right) { return true; }, false);
  for (const char* command : {"undo ", "claim ", "rollback apply ", "ban ", "grant ", "role set ",
                              "stop", "FILTERS", "BOX"}) {
    CHECK(lists(all, command));
  }
  CHECK_FALSE(lists(all, "backup "));
  CHECK(lists(command_help([](Right) { return true; }, true), "backup "));
}

TEST_CASE("no two rows begin with the same words", "[admin][command]") {
  std::set<std::string_view> words;
  for (const CommandRow& row : command_table()) {
    CAPTURE(std::string(row.words));
    CHECK(words.insert(row.words).second);
  }
}

TEST_CASE("the reference lists each command and who may give it", "[admin][docs]") {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/server-reference.md");
  std::string line;
  while (std::getline(file, line) && line != "| command | needs | does |") {
  }
  std::getline(file, line);
  std::map<std::string_view, std::string> documented;  // the second column, by the words of the row
  while (std::getline(file, line) && !line.empty()) {
    CAPTURE(line);
    const std::size_t names_end = line.find('|', 1);
    const std::size_t needs_end = line.find('|', names_end + 1);
    REQUIRE(needs_end != std::string::npos);
    for (std::size_t at = line.find('`'); at < names_end; at = line.find('`', at + 1)) {
      const std::size_t end = line.find('`', at + 1);
      const auto words = command_words(line.substr(at + 1, end - at - 1));
      REQUIRE(words.has_value());
      const CommandRow* row = find_command(*words);
      REQUIRE(row != nullptr);
      documented[row->words] = line.substr(names_end + 1, needs_end - names_end - 1);
      at = end;
    }
  }
  for (const CommandRow& row : command_table()) {
    CAPTURE(std::string(row.words));
    REQUIRE(documented.contains(row.words));
    std::string rights;
    for (std::size_t i = 0; i < kRightCount; ++i) {
      const auto right = static_cast<Right>(i);
      if (!row.rule.any_of.has(right)) continue;
      rights += (rights.empty() ? " `" : " or `") + std::string(name_of(right)) + "`";
    }
    const std::string& needs = documented[row.words];
    if (row.rule.is_local) CHECK(needs.ends_with(" `control` "));
    if (!row.rule.is_local) CHECK(needs == rights + " ");
  }
}

TEST_CASE("the log of the server has no more than the first word of a command with a secret",
          "[admin][command]") {
  for (const char* line :
       {"password set hunter2", "  password hunter2", "\"password\" hunter2", "passwordhunter2"})
    CHECK(logged_command(line) == "password ...");
  CHECK(logged_command(" say the password") == " say the password");
}

TEST_CASE("a server that follows carries out status, reload and stop", "[admin][command]") {
  std::string done;
  OperatorActions actions;
  actions.stop = [&done] { done += "stop "; };
  const auto answer_to = [&](const std::string& line) {
    CommandAnswer last;
    give_command(
        FollowerCall{actions, "follows", [&last](const CommandAnswer& answer) { last = answer; }},
        line);
    CHECK(last.is_done);
    return last.is_ok ? "ok " + last.text : last.text;
  };
  CHECK(answer_to("status") == "ok follows");
  CHECK(answer_to("  status ") == "ok follows");
  CHECK(answer_to("stop") == "ok ");
  for (const char* line : {"reload", "players", "status now", ""})
    CHECK(answer_to(line) == kGiveThere);
  actions.reload = [&done](const CommandReply& reply) {
    done += "reload";
    reply(CommandAnswer::last("reloaded"));
  };
  CHECK(answer_to("reload") == "ok reloaded");
  CHECK(done == "stop reload");
}

}  // namespace runstone::test
