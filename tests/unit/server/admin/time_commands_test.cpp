#include "server/admin/time_commands.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/admin/command_bench.hpp"
#include "tests/unit/server/admin/parsed_command.hpp"

namespace runstone::test {
namespace {

struct TimeBench : CommandBench {
  TimeBench()
      : services{bench.server,
                 service,
                 *this,
                 placing,
                 folder.path(),
                 {},
                 [](const PublicKey&) {
                   return false; }} {}
  CommandAnswer give(const std::string& line, const CommandCaller& caller = {}) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  CommandServices services;
};

}  // namespace

TEST_CASE("the lines about the time of the world are parsed", "[admin][world_time]") {
  CHECK(row_of("time") == "time");
  CHECK(row_of("time 21:00") == "time HH:MM");
  CHECK(row_of("time rate 20") == "time rate");
  CHECK(mistake("time 25:00") ==
        "time \"25:00\": a time from 0:00 to 23:59, such as 21:00, or rate N");
  CHECK(mistake("time 21:00 soon") == "time: a time from 0:00 to 23:59, such as 21:00");
  CHECK(mistake("time rate 1000000") == "time rate \"1000000\": a number from 0 to 10000");
  CHECK(mistake("time rate -1") == "time rate \"-1\": a number from 0 to 10000");
  CHECK(mistake("time rate 20 now") == "time rate N \"now\": nothing comes after it");
}

TEST_CASE("the console sets the time and its rate, and everybody may read it",
          "[admin][world_time]") {
  TimeBench bench;
  CHECK(bench.give("time").text.starts_with("the world has no time of day"));
  CHECK(bench.give("time 21:00").text ==
        "the time of the world is 21:00, and it stands still (rate 0) (record 1)");
  CHECK(bench.give("time rate 20").text ==
        "the time of the world is 21:00 at rate 20: a day takes 72 min (record 2)");
  CHECK(bench.give("time").text == "the time of the world is 21:00 at rate 20: a day takes 72 min");
  CHECK(bench.give("time rate 10000").text.ends_with("a day takes 8.6 s (record 3)"));
  CHECK(bench.bench.server.order().clock().record() == 3);
}

TEST_CASE("a player without the right reads the time and does not set it", "[admin][world_time]") {
  TimeBench bench;
  bench.join(1);
  CommandCaller caller;
  caller.author = 1;
  caller.actor.key = key_pair_of(seed_of(1)).public_key;
  CHECK(bench.give("time", caller).is_ok);
  const CommandAnswer refused = bench.give("time 21:00", caller);
  CHECK_FALSE(refused.is_ok);
  CHECK_FALSE(bench.bench.server.order().clock().is_set());
}

}  // namespace runstone::test
