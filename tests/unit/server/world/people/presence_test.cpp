#include "server/world/people/presence.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {

using Bench = WorldBench;

TEST_CASE("changed poses are sent to every session, at most ten times a second", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.tick(100'000);
  const std::size_t before = bench.environment.messages<PlayerPoses>(1, kEdge).size();
  bench.tick(100'000);
  CHECK(bench.environment.messages<PlayerPoses>(1, kEdge).size() == before);
  Pose pose;
  pose.at = {1, 2, 3};
  bench.server.received(2, Move{pose}, bench.now());
  bench.server.received(2, Move{pose}, bench.now());
  bench.tick(50'000);
  CHECK(bench.environment.messages<PlayerPoses>(1, kEdge).size() == before);
  bench.tick(50'000);
  const auto poses = bench.environment.messages<PlayerPoses>(1, kEdge);
  REQUIRE(poses.size() == before + 1);
  REQUIRE(poses.back().players.size() == 1);
  CHECK(poses.back().players[0].author == 2);
  CHECK(poses.back().players[0].pose == pose);
}

TEST_CASE("the player list has the roles of players, and a change of them is sent",
          "[world][rights]") {
  Bench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  bench.tick();
  const auto lists = [&] { return bench.environment.messages<PlayerList>(1, kEdge); };
  REQUIRE_FALSE(lists().empty());
  const std::size_t before = lists().size();
  CHECK_FALSE(lists().back().players.at(0).role.empty());
  const PublicKey two = key_pair_of(seed_of(2)).public_key;
  REQUIRE(bench.server.changes().change_rights(GrantRole{two, kModeratorRole}, {}, 0, bench.now()));
  bench.tick();
  REQUIRE(lists().size() == before + 1);
  const PlayerList change = lists().back();
  CHECK(change.is_change);
  REQUIRE(change.players.size() == 1);
  CHECK(change.players[0].key == two);
  CHECK(change.players[0].role == kModeratorRole);
  REQUIRE(bench.server.changes().change_rights(GrantRole{two, kModeratorRole}, {}, 0, bench.now()));
  bench.tick();
  CHECK(lists().size() == before + 1);  // nothing changed
}

TEST_CASE("with many players poses are sent less often, some at a time, and every player's in turn",
          "[world]") {
  WorldConfig c = config();
  c.pose_interval_us = 10'000;
  Bench bench(c);
  constexpr std::uint8_t kPlayers = 150;  // 75 ms
  const auto move_all = [&](double x) {
    Pose pose;
    pose.at = {x, 0, 0};
    for (SessionId id = 1; id <= kPlayers; ++id) bench.server.received(id, Move{pose}, bench.now());
  };
  for (SessionId id = 1; id <= kPlayers; ++id) bench.join(id, static_cast<std::uint8_t>(id));
  bench.environment.sent.clear();
  move_all(1);
  for (int i = 0; i < 3; ++i) bench.tick(30'000);
  CHECK(bench.environment.messages<PlayerPoses>(1, kEdge).size() == 1);
  for (int i = 0; i < 2; ++i) {
    move_all(2 + i);  // every player moves all the time
    bench.tick(kPoseIntervalUsPerSession * kPlayers);
  }
  const auto poses = bench.environment.messages<PlayerPoses>(1, kEdge);
  REQUIRE(poses.size() == 3);
  std::set<AuthorId> seen;
  for (const PlayerPoses& some : poses) {
    CHECK(some.players.size() <= kPosesMax);
    for (const PlayerPose& one : some.players) seen.insert(one.author);
  }
  CHECK(seen.size() == kPlayers);
}

TEST_CASE("the player list is sent in full once, then as changes, and in full after a full queue",
          "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.tick();
  bench.join(2, 2);
  bench.join(3, 3);
  bench.tick();
  auto lists = bench.environment.messages<PlayerList>(1, kEdge);
  REQUIRE(lists.size() == 2);
  CHECK_FALSE(lists[0].is_change);
  CHECK(lists[1].is_change);
  CHECK(lists[1].players ==
        std::vector<PlayerName>{{2, "player2", key_pair_of(seed_of(2)).public_key, kBuilderRole},
                                {3, "player3", key_pair_of(seed_of(3)).public_key, kBuilderRole}});
  lists = bench.environment.messages<PlayerList>(3, kEdge);
  REQUIRE(lists.size() == 1);
  CHECK_FALSE(lists[0].is_change);
  CHECK(lists[0].players.size() == 3);
  bench.environment.full.insert(1);
  bench.server.disconnected(2);
  bench.tick();
  bench.environment.full.clear();
  bench.tick();
  lists = bench.environment.messages<PlayerList>(1, kEdge);
  REQUIRE(lists.size() == 3);
  CHECK_FALSE(lists[2].is_change);
  CHECK(lists[2].players.size() == 2);
  lists = bench.environment.messages<PlayerList>(3, kEdge);
  REQUIRE(lists.size() == 2);
  CHECK(lists[1].is_change);
  CHECK(lists[1].left == std::vector<AuthorId>{2});
  bench.tick();
  CHECK(bench.environment.messages<PlayerList>(3, kEdge).size() == 2);  // nothing changed
}

TEST_CASE("a second client of a player changes nothing in the player list", "[world]") {
  Bench bench;
  bench.join(1, 1);
  bench.tick();
  bench.join(2, 1, 77);
  bench.tick();
  bench.server.disconnected(2);
  bench.tick();
  CHECK(bench.environment.messages<PlayerList>(1, kEdge).size() == 1);
}

}  // namespace runstone::test
