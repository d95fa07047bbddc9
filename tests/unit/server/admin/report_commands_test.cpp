#include "server/admin/report_commands.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/admin/command_table.hpp"
#include "server/admin/player_reports.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kPauseUs = PlayerReports::kPauseUs;

PlayerReport report_of(std::uint8_t who) {
  PlayerReport report;
  report.key = PublicKey{who};
  return report;
}

/// A builder, and a moderator whose client reads the chat.
struct ReportBench : CommandBench {
  ReportBench()
      : services{
            bench.server, service, *this, placing, folder.path(), actions(), [](const PublicKey&) {
              return false;
            }} {
    join(kBuilder);
    bench.join(kModerator, kModerator, 1, {}, kFeatureChat);
    const PublicKey key = key_of(kModerator);
    REQUIRE(bench.server.changes().change_rights(GrantRole{key, "moderator"}, {}, 0, bench.now()));
  }
  static constexpr std::uint8_t kModerator = 9;
  static PublicKey key_of(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    return answer();
  }
  CommandAnswer player(std::uint8_t who, const std::string& line) {
    return give({who, {key_of(who), false}}, line);
  }
  std::vector<std::string> logged;
  CommandServices services;

 private:
  OperatorActions actions() {
    OperatorActions all;
    all.log_line = [this](const std::string& line) { logged.push_back(line); };
    return all;
  }
};

}  // namespace

TEST_CASE("a player reports with the place, and moderators are told, list and close it",
          "[admin][report]") {
  ReportBench bench;
  CHECK(bench.give({}, "reports").text == "no report is open");
  const CommandAnswer taken = bench.player(kBuilder, "report \"the mole, jr.\" digs my 'house'");
  CHECK(taken.is_ok);
  const std::string line = bench.give({}, "reports").text;
  CHECK(line.starts_with("1 "));
  CHECK(contains(line, " player2 #"));
  CHECK(contains(line, key_fingerprint(ReportBench::key_of(kBuilder)) + " at "));
  CHECK(line.ends_with(": \"the mole, jr.\" digs my 'house'"));
  REQUIRE(bench.logged.size() == 1);
  CHECK(bench.logged[0] == "report " + line);
  const auto lines = bench.bench.environment.messages<ChatLines>(ReportBench::kModerator, kEdge);
  REQUIRE_FALSE(lines.empty());
  REQUIRE_FALSE(lines.back().lines.empty());
  CHECK(contains(lines.back().lines.back().text, "report 1 of player2 at "));

  CHECK_FALSE(bench.player(kBuilder, "reports").is_ok);
  CHECK_FALSE(bench.player(kBuilder, "reports close 1").is_ok);
  CHECK(contains(bench.player(ReportBench::kModerator, "reports close 2").text,
                 "no open report has that number"));
  CHECK(bench.player(ReportBench::kModerator, "reports close 1").text == "closed: " + line);
  CHECK(bench.give({}, "reports").text == "no report is open");
}

TEST_CASE("several reports are closed in one line, all or none", "[admin][report]") {
  ReportBench bench;
  for (int i = 0; i < 3; ++i) {
    CHECK(bench.player(kBuilder, "report he digs").is_ok);
    bench.bench.time_us += kPauseUs;
  }
  CHECK(bench.give({}, "reports close 1 9 3").text ==
        "reports close 9: no open report has that number (reports lists them); none of these was "
        "closed");
  const std::string list = bench.give({}, "reports").text;
  CHECK(bench.give({}, "reports close 3 1 3").text ==
        "closed: " + list.substr(0, list.find('\n')) +
            "\nclosed: " + list.substr(list.rfind('\n') + 1));
  CHECK(bench.give({}, "reports").text.starts_with("2 "));
  CHECK(contains(bench.give({}, "reports close 2 all").text, "reports close \"all\""));
}

TEST_CASE("one range of addresses does not close the reports for everybody", "[admin][report]") {
  PlayerReports reports;
  const auto taken = [&](std::uint8_t first_key, AddressBlock from) {
    std::size_t count = 0;
    for (std::uint8_t i = 0; i < 2 * PlayerReports::kOpenOfRangeMax; ++i) {
      PlayerReport report = report_of(static_cast<std::uint8_t>(first_key + i));
      report.from = from;
      if (reports.add(report, 1'000)) ++count;
    }
    return count;
  };
  CHECK(taken(20, address_block_v4(0xc000'0207)) == PlayerReports::kOpenOfRangeMax);
  CHECK(taken(40, address_block_v4(0xc000'0208)) == 0);  // the same /24
  CHECK(taken(60, address_block_v4(0xc000'0307)) == PlayerReports::kOpenOfRangeMax);
  CHECK(taken(80, address_block_v4(0x7f00'0001)) == 2 * PlayerReports::kOpenOfRangeMax);  // a proxy
  REQUIRE(reports.close(1).has_value());
  CHECK(taken(100, address_block_v4(0xc000'0208)) == 1);
}

TEST_CASE("a muted player, the console and an empty text report nothing", "[admin][report]") {
  ReportBench bench;
  CHECK(contains(bench.give({}, "report help").text, "players report"));
  CHECK(contains(bench.player(kBuilder, "report").text, "report: the text is refused"));
  CHECK(contains(bench.player(kBuilder, "report \x01").text, "report: the text is refused"));
  const Restrict mute{RestrictionKind::mute, ReportBench::key_of(kBuilder), 0, ""};
  REQUIRE(bench.bench.server.changes().change_rights(mute, {}, 0, bench.bench.now()));
  CHECK(contains(bench.player(kBuilder, "report he digs").text, "you are muted"));
  CHECK(bench.logged.empty());
}

TEST_CASE("reports are bounded for each player and in all", "[admin][report]") {
  PlayerReports reports;
  TimeUs now = 1'000;
  const auto first = reports.add(report_of(1), now);
  REQUIRE(first.has_value());
  CHECK(*first == 1);
  CHECK_FALSE(reports.add(report_of(1), now + kPauseUs - 1).has_value());
  const auto second = reports.add(report_of(2), now + 1);  // another player
  REQUIRE(second.has_value());
  CHECK(*second == 2);
  for (std::size_t i = 1; i < PlayerReports::kOpenOfPlayerMax; ++i)
    CHECK(reports.add(report_of(1), now += kPauseUs).has_value());
  const auto refused = reports.add(report_of(1), now += kPauseUs);
  REQUIRE_FALSE(refused.has_value());
  CHECK(contains(refused.error(), "open reports: wait until"));
  REQUIRE(reports.close(1).has_value());
  CHECK(reports.add(report_of(1), now).has_value());
  CHECK_FALSE(reports.close(1).has_value());

  PlayerReports full;
  std::size_t taken = 0;
  for (std::uint32_t who = 0; who < 400; ++who) {
    PlayerReport report;
    report.key = PublicKey{static_cast<std::uint8_t>(who), static_cast<std::uint8_t>(who >> 8)};
    if (full.add(report, now)) ++taken;
  }
  CHECK(taken == PlayerReports::kOpenMax);
  CHECK(full.open().size() == PlayerReports::kOpenMax);
}

}  // namespace runstone::test
