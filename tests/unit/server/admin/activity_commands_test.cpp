#include "server/admin/activity_commands.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

KnownPlayers players_named(const std::vector<std::string>& names) {
  KnownPlayers::Sources sources;
  AuthorId author = 0;
  for (const std::string& name : names) {
    ++author;
    sources.stored.push_back({author, PublicKey{static_cast<std::uint8_t>(author)}, name});
  }
  return KnownPlayers(sources);
}

std::string mistake_in(const std::string& line) {
  const auto command = parse_command(line, 0);
  return command ? "" : command.error();
}

}  // namespace

TEST_CASE("activity as CSV keeps hostile names in their column", "[admin][activity]") {
  const KnownPlayers players = players_named({"ana, the \"mole\"", "=HYPERLINK(1)", "bob"});
  ActivityReport report;
  report.players = {{1, 5, 60, 61'000'000, 0, 1'000'000}, {2, 4, 3, 0, 0, 0}, {9, 1, 1, 0, 0, 0}};
  report.is_complete = false;
  const std::string csv = activity_csv(report, players, {1});
  CHECK(contains(csv,
                 "author,name,fingerprint,edits,voxels,building_s,first_edit,last_edit,"
                 "is_here,counted_from\n1,\"ana, the \"\"mole\"\"\","));
  CHECK(contains(csv,
                 ",5,60,61,1970-01-01T00:00:00Z,1970-01-01T00:00:01Z,1,1970-01-01T00:00:00Z\n"
                 "2,'=HYPERLINK(1),"));
  CHECK(contains(csv, "\n9,,,1,1,0,"));
  report.is_complete = true;
  CHECK(activity_csv(report, players, {}).ends_with(",0,"));
}

TEST_CASE("activity as a table says what it has left out", "[admin][activity]") {
  const KnownPlayers players = players_named({"ana"});
  CHECK(activity_table({}, players, {}) == "no edit matches");
  ActivityReport report;
  report.players = {{1, 5, 60, 61'000'000, 0, 1'000'000}};
  report.players_found = 1;
  const std::string table = activity_table(report, players, {1});
  CHECK(contains(table,
                 "\n         5          60    1 min 1 s  1970-01-01T00:00:00Z  "
                 "1970-01-01T00:00:01Z  ana #1 "));
  CHECK(table.ends_with(", is here"));
  report.players_found = 4;
  report.is_complete = false;
  CHECK(contains(activity_table(report, players, {}), "\nand 3 more players"));
  CHECK(contains(activity_table(report, players, {}), "\nolder edits than 1970-01-01T00:00:00Z"));
}

TEST_CASE("activity is read for the players and the time that the line names",
          "[admin][activity]") {
  CommandBench bench;
  bench.join(kGriefer);
  bench.join(kBuilder);
  bench.set(kGriefer, {1, 2, 3}, 1);
  bench.set(kGriefer, {1, 2, 4}, 1);
  bench.set(kBuilder, {1, 2, 5}, 1);
  bench.write_log();
  CommandServices services = bench.services();
  const auto give = [&](const std::string& line) {
    bench.answers.clear();
    give_command({services, {}, bench.bench.now(), bench.reply()}, line);
    while (bench.work()) {
    }
    return bench.answer().text;
  };
  CHECK(contains(give("activity"), "player1"));
  CHECK(contains(give("activity"), "player2"));
  const std::string one = give("activity by player1 --csv");
  CHECK(contains(one, ",player1,"));
  CHECK_FALSE(contains(one, "player2"));
  CHECK(contains(give("activity by nobody"), "nobody of that name is known here"));
}

TEST_CASE("a mistake in activity names the wrong word", "[admin][activity]") {
  CHECK(mistake_in("activity today") ==
        "activity \"today\": by PLAYER, since MOMENT, until MOMENT, limit N or --csv");
  CHECK(contains(mistake_in("activity limit 0"), "limit \"0\""));
  CHECK(contains(mistake_in("activity by"), "activity by"));
  CHECK(mistake_in("activity since 1d limit 5 --csv").empty());
}

}  // namespace runstone::test
