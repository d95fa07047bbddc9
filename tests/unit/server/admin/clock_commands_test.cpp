#include "server/admin/clock_commands.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

constexpr TimeUs kOneSecond = 1'000'000;
constexpr TimeUs kHour = 3'600 * kOneSecond;
constexpr TimeUs kYear = 365 * 24 * kHour;
constexpr SessionId kMoleSession = 1, kAnaSession = 2;

/// Returns a start whose log ends so far ahead of the bench's wall clock.
WorldStart start_ahead(TimeUs ahead_us) {
  WorldStart start;
  start.log.last_time_us = WorldBench().now().utc_us + ahead_us;
  return start;
}

struct ClockBench : CommandBench {
  explicit ClockBench(TimeUs ahead_us) : ClockBench(start_ahead(ahead_us)) {}
  explicit ClockBench(const WorldStart& start)
      : CommandBench(config(), start),
        services{
            bench.server, service, *this, placing, folder.path(), actions(), [](const PublicKey&) {
              return false;
            }} {
    join(kMoleSession);
    join(kAnaSession);
    tick();
  }
  OperatorActions actions() {
    OperatorActions all;
    all.doubt_clock = [this](TimeUs wall_us) {
      asked_us = wall_us;
      return doubt;
    };
    return all;
  }
  CommandAnswer give(const std::string& line) {
    answers.clear();
    give_command({services, {}, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  std::string done(const std::string& line) {
    const CommandAnswer given = give(line);
    INFO(line << ": " << given.text);
    CHECK(given.is_ok);
    return given.text;
  }
  void wait(TimeUs us) {
    for (const TimeUs end_us = bench.time_us + us; bench.time_us < end_us;) bench.tick(kOneSecond);
  }
  bool holds(RestrictionKind kind, std::uint8_t who) {
    const Rights& rights = bench.server.rights();
    const PublicKey key = key_pair_of(seed_of(who)).public_key;
    return rights.state().restriction(kind, key, rights.time()) != nullptr;
  }
  /// Returns the lines of an answer.
  static std::size_t lines(const std::string& text) {
    return text.empty() ? 0 : static_cast<std::size_t>(std::ranges::count(text, '\n')) + 1;
  }

  std::optional<std::string> doubt;  // the answer of OperatorActions::doubt_clock()
  TimeUs asked_us = 0;               // its last argument
  CommandServices services;
};

bool tells(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a clock that was ahead once does no more harm after `clock correct`", "[admin][clock]") {
  ClockBench bench(2 * kYear + kHour / 2);
  bench.set(kAnaSession, {1, 1, 1}, 1);
  bench.done("mute player2 for 5s");
  bench.done("freeze player2 for 1h");
  bench.wait(10 * kOneSecond);
  CHECK_FALSE(bench.holds(RestrictionKind::mute, 2));
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  CHECK(tells(bench.done("clock"),
              "the log is 730d ahead. If the wall clock is right, `clock correct`"));
  const TimeUs before_us = bench.bench.server.rights().time();
  const std::string text = bench.done("clock correct");
  CHECK(tells(text, "the time of the log goes back from "));
  CHECK(tells(text, "(record 4)"));
  CHECK(bench.bench.environment.records.back().time_us < before_us - kYear);
  CHECK(tells(bench.done("clock"), ": they agree"));
  CHECK_FALSE(bench.holds(RestrictionKind::mute, 2));
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  bench.wait(kHour - 60 * kOneSecond);
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  // The correction is older than 30 minutes, so `since` means what it says.
  bench.done("mute player1 for 1m");
  CHECK(bench.lines(bench.done("log since 30m")) == 1);
  CHECK(bench.lines(bench.done("log since 2h")) == 5);  // and all that the wrong clock stamped
  bench.wait(2 * 60 * kOneSecond);
  CHECK_FALSE(bench.holds(RestrictionKind::freeze, 2));
  CHECK(bench.store->check().has_value());
}

TEST_CASE("there is nothing to correct while both clocks agree", "[admin][clock]") {
  ClockBench bench(0);
  CHECK(tells(bench.done("clock"), ": they agree"));
  const CommandAnswer refused = bench.give("clock correct");
  CHECK_FALSE(refused.is_ok);
  CHECK(tells(refused.text, "clock correct: there is nothing to correct"));
  CHECK_FALSE(bench.give("clock correct anyway").is_ok);
  CHECK(bench.give("clock correct now").text == "clock correct \"now\": nothing comes after it");
  CHECK(bench.bench.server.order().head() == 0);
}

TEST_CASE("a wall clock that has jumped just now is taken only on confirmation", "[admin][clock]") {
  ClockBench bench(0);
  const bool is_back = GENERATE(true, false);
  bench.bench.wall_error_us = is_back ? -kYear : kYear;
  bench.bench.tick(kOneSecond);
  CHECK(tells(bench.done("clock"), "The wall clock has jumped"));
  const CommandAnswer refused = bench.give("clock correct");
  CHECK_FALSE(refused.is_ok);
  CHECK(tells(refused.text, "give the command as: clock correct anyway"));
  CHECK(bench.bench.server.order().head() == 0);
  bench.done("clock correct anyway");
  CHECK(bench.bench.server.order().head() == (is_back ? 1 : 0));
  const TimeUs apart_us = bench.bench.server.rights().time() - bench.bench.now().utc_us;
  CHECK(std::abs(apart_us) <= kOneSecond);
}

TEST_CASE("a restriction counts by what has passed when the log follows a clock that is ahead",
          "[admin][clock]") {
  ClockBench bench(0);
  const bool is_by_command = GENERATE(true, false);
  bench.bench.wall_error_us = kYear;
  bench.bench.tick(kOneSecond);
  bench.done("freeze player2 for 3h");
  const TimeUs end_us = bench.bench.time_us + 3 * kHour;  // of the steady clock
  if (is_by_command) {
    const std::string text = bench.done("clock correct anyway");
    CHECK(tells(text, "the time of the log goes on from "));
    CHECK(tells(text, "(record 2)"));
  } else {
    bench.wait(kHour + 5 * kOneSecond);
    const auto& lines = bench.bench.environment.lines;
    CHECK(std::ranges::count_if(lines, [](const std::string& line) {
            return tells(line, "the wall clock has kept its jump: ") && tells(line, "(record 2)");
          }) == 1);
  }
  CHECK(corrects_time(bench.bench.environment.records.back()));
  CHECK(tells(bench.done("clock"), ": they agree"));
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  bench.wait(end_us - bench.bench.time_us - 60 * kOneSecond);
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  bench.wait(2 * 60 * kOneSecond);
  CHECK_FALSE(bench.holds(RestrictionKind::freeze, 2));
  CHECK(bench.store->check().has_value());
}

TEST_CASE("a log without restrictions follows a clock that is ahead without a record",
          "[admin][clock]") {
  ClockBench bench(0);
  bench.done("freeze player2 for 10s");
  bench.bench.wall_error_us = kYear;
  bench.wait(kHour + 5 * kOneSecond);
  CHECK(bench.bench.server.order().head() == 1);
  CHECK(tells(bench.done("clock"), ": they agree"));
}

TEST_CASE("a start that doubts its clock loses no ban when the host corrects the time",
          "[admin][clock]") {
  WorldStart start;
  start.log.begin_us = WorldBench().now().utc_us - 900 * kOneSecond;
  ClockBench bench(start);
  bench.done("freeze player2 for 10m");
  bench.done("clock correct anyway");
  bench.wait(9 * 60 * kOneSecond);
  CHECK(bench.holds(RestrictionKind::freeze, 2));
  bench.wait(2 * 60 * kOneSecond);
  CHECK_FALSE(bench.holds(RestrictionKind::freeze, 2));
}

TEST_CASE("a wall clock that is doubtful and behind the log is taken only on confirmation",
          "[admin][clock]") {
  // The clock of this machine begins in 1970: nothing has set it.
  ClockBench bench(56 * kYear);
  bench.doubt = "no time service has set it";
  const CommandAnswer refused = bench.give("clock correct");
  CHECK_FALSE(refused.is_ok);
  CHECK(tells(refused.text, "the wall clock may be wrong, because no time service has set it: "));
  CHECK(tells(refused.text, "give the command as: clock correct anyway"));
  CHECK(std::abs(bench.asked_us - bench.bench.now().utc_us) <= kOneSecond);
  CHECK(bench.bench.server.order().head() == 0);
  bench.done("clock correct anyway");
  CHECK(bench.bench.server.order().head() == 1);
}

TEST_CASE("a correction before the first tick leaves a ban the time that it had",
          "[admin][clock]") {
  WorldStart start = start_ahead(2 * kYear);
  const PublicKey mole = key_pair_of(seed_of(2)).public_key;
  const TimeUs given_us = start.log.last_time_us;
  start.log.last = start.log.last_epoch = 1;
  start.rights.push_back(
      {Restrict{RestrictionKind::ban, mole, given_us + kHour, ""}, {1, 0, given_us}});
  CommandBench bench(config(), start);
  CommandServices services = bench.services();
  give_command({services, {}, bench.bench.now(), bench.reply()}, "clock correct");
  CHECK(bench.bench.server.order().head() == 2);
  const auto* ban =
      bench.bench.server.rights().state().find_restriction(RestrictionKind::ban, mole);
  REQUIRE(ban != nullptr);
  CHECK(ban->value.until_us == bench.bench.now().utc_us + kHour);
}

TEST_CASE("a correction cannot be taken back", "[admin][clock]") {
  ClockBench bench(2 * kYear);
  bench.done("clock correct");
  const CommandAnswer refused = bench.give("rights undo 1");
  CHECK_FALSE(refused.is_ok);
  CHECK(tells(refused.text, "cannot be taken back"));
}

}  // namespace runstone::test
