// The commands about the spawn.
#include "server/admin/spawn_commands.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {
namespace {

struct SpawnBench : CommandBench {
  explicit SpawnBench(WorldConfig c = config())
      : CommandBench(std::move(c)), services{bench.server,
                                             service,
                                             *this,
                                             placing,
                                             folder.path(),
                                             {},
                                             [](const PublicKey&) {
              return false; }} {
    join(kBuilder);
  }
  static PublicKey key_of(SessionId who) {
    return key_pair_of(seed_of(static_cast<std::uint8_t>(who))).public_key;
  }
  CommandAnswer give(const CommandCaller& caller, const std::string& line) {
    answers.clear();
    give_command({services, caller, bench.now(), reply()}, line);
    for (int i = 0; i < 3; ++i) {
      run_all();
      services.tick(bench.now());
    }
    return answer();
  }
  /// Lets a new player join, and returns where the server says that players begin.
  WorldPos welcomed(SessionId session) {
    bench.join(session, static_cast<std::uint8_t>(session));
    return bench.environment.messages<Welcome>(session, 0).at(0).spawn;
  }

  CommandServices services;
};

}  // namespace

TEST_CASE("the spawn is set by place and by the player who stands there, and saved",
          "[admin][spawn]") {
  SpawnBench bench;
  const CommandAnswer set = bench.give({}, "spawn 5 7 -9");
  INFO(set.text);
  REQUIRE(set.is_ok);
  CHECK(contains(set.text, "the spawn is at 5.5 7.0 -8.5 "));
  CHECK(bench.welcomed(7) == WorldPos{5.5, 7, -8.5});
  REQUIRE_FALSE(bench.bench.environment.states.empty());
  CHECK(bench.bench.environment.states.back().spawn == WorldPos{5.5, 7, -8.5});

  bench.bench.server.received(kBuilder, Move{{{1.25, 2, 3}, 0, 0}}, bench.bench.now());
  const PublicKey key = SpawnBench::key_of(kBuilder);
  CHECK_FALSE(bench.give({kBuilder, {key, false}}, "spawn here").is_ok);
  CHECK(bench.give({kBuilder, {key, true}}, "spawn here").is_ok);
  CHECK(bench.welcomed(8) == WorldPos{1.25, 2, 3});
  CHECK(contains(bench.give({}, "spawn").text, "the spawn is at 1.2 2.0 3.0; no ground is kept"));
  CHECK(contains(bench.give({}, "spawn here").text, "spawn here is for players"));
  CHECK_FALSE(bench.give({}, "spawn 5 7").is_ok);
  CHECK_FALSE(bench.give({}, "spawn 5 7 999999999").is_ok);
}

TEST_CASE("no spawn lies beyond the border", "[admin][spawn]") {
  WorldConfig bounded = config();
  bounded.border = BorderCircle{0, 0, 5};
  SpawnBench bench(bounded);
  CHECK(contains(bench.give({}, "spawn 9 7 0").text, "beyond the border of this world: 5 voxels"));
  CHECK(bench.give({}, "spawn 4 7 0").is_ok);
}

TEST_CASE("the ground around the spawn is kept clear", "[admin][spawn]") {
  SpawnBench bench;
  REQUIRE(bench.give({}, "spawn 5 2 5").is_ok);
  CHECK_FALSE(bench.give({}, "spawn keep-clear 0").is_ok);
  CHECK_FALSE(bench.give({}, "spawn keep-clear 1001").is_ok);
  const CommandAnswer kept = bench.give({}, "spawn keep-clear 2");
  INFO(kept.text);
  REQUIRE(kept.is_ok);
  bench.set(kBuilder, {3, 1, 3}, 1);
  bench.set(kBuilder, {7, 6, 7}, 1);
  bench.set(kBuilder, {8, 1, 7}, 1);
  bench.write_log();
  CHECK(bench.at({3, 1, 3}) == kEmpty);
  CHECK(bench.at({7, 6, 7}) == kEmpty);
  CHECK(bench.at({8, 1, 7}) == 1);
  const auto rejected = bench.bench.environment.messages<Reject>(kBuilder, kEdge);
  REQUIRE(rejected.size() == 2);
  CHECK(contains(rejected[0].detail, "spawn"));
  CHECK(bench.give({}, "spawn 20 2 5").is_ok);
  CHECK(contains(bench.give({}, "spawn").text, "which does not hold the spawn"));
  CHECK(bench.give({}, "spawn keep-clear 0").is_ok);
  bench.set(kBuilder, {3, 1, 3}, 1);
  bench.write_log();
  CHECK(bench.at({3, 1, 3}) == 1);
}

}  // namespace runstone::test
