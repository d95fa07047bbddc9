#include "server/world/people/player_places.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/commit/feature_bench.hpp"

namespace runstone::test {
namespace {

PublicKey key_of_player(std::size_t number) {
  PublicKey key{};
  key[0] = static_cast<std::uint8_t>(number);
  key[1] = static_cast<std::uint8_t>(number >> 8);
  return key;
}

Pose pose_at(double x) { return {{x, 70.5, -3}, 16384, -100}; }

}  // namespace

TEST_CASE("the place of the player who was seen longest ago is forgotten first",
          "[world][places]") {
  PlayerPlaces places({});
  for (std::size_t i = 0; i < kPlayerPlacesMax; ++i)
    places.note(key_of_player(i), pose_at(static_cast<double>(i)));
  places.note(key_of_player(0), pose_at(0.5));
  places.note(key_of_player(kPlayerPlacesMax), pose_at(9));
  CHECK(places.all().size() == kPlayerPlacesMax);
  CHECK(places.find(key_of_player(0)) == pose_at(0.5));
  CHECK(places.find(key_of_player(1)) == std::nullopt);
  CHECK(places.find(key_of_player(2)) == pose_at(2));
  CHECK(places.all().back() == LastPlace{key_of_player(kPlayerPlacesMax), pose_at(9)});
  const PlayerPlaces again(places.all());
  CHECK(again.all() == places.all());
}

TEST_CASE("a player joins where the player left, and a new one at the spawn", "[world][places]") {
  WorldConfig c = config();
  c.spawn = {1, 2, 3};
  FeatureBench bench(c);
  const auto accepted = [&](SessionId session) {
    return bench.environment.messages<SessionAccepted>(session, kEdge).at(0);
  };
  bench.join_with(1, 1, kFeatureVisits);
  CHECK(accepted(1).place == std::nullopt);
  CHECK(bench.server.people().online().at(0).at == c.spawn);
  bench.server.received(1, Move{pose_at(40)}, bench.now());
  bench.server.disconnected(1);
  bench.join_with(2, 1, kFeatureVisits);
  CHECK(accepted(2).place == pose_at(40));
  CHECK(bench.server.people().online().at(0).at == pose_at(40).at);
  bench.server.disconnected(2);
  // A client that does not know places begins at the spawn, and leaves no place.
  bench.join_with(3, 1, kFeatureChat);
  CHECK(accepted(3).place == std::nullopt);
  bench.server.received(3, Move{pose_at(-9)}, bench.now());
  bench.server.disconnected(3);
  bench.join_with(4, 1, kFeatureVisits);
  CHECK(accepted(4).place == pose_at(40));
}

TEST_CASE("a client that connects again begins where its older session is", "[world][places]") {
  FeatureBench bench;
  const auto accepted = [&](SessionId session) {
    return bench.environment.messages<SessionAccepted>(session, kEdge).at(0);
  };
  bench.join_with(1, 1, kFeatureVisits);
  bench.server.received(1, Move{pose_at(40)}, bench.now());
  bench.join_with(2, 1, kFeatureVisits);  // the same client: session 1 is closed
  CHECK(accepted(2).place == pose_at(40));
  bench.server.received(2, Move{pose_at(60)}, bench.now());
  bench.server.disconnected(2);
  bench.join_with(3, 1, kFeatureVisits);
  CHECK(accepted(3).place == pose_at(60));
}

TEST_CASE("a session that ends leaves the place of another session of the player",
          "[world][places]") {
  FeatureBench bench;
  bench.join(1, 1, 1, {}, kFeatureVisits);
  bench.server.received(1, Move{pose_at(40)}, bench.now());
  bench.join(2, 1, 2, {}, kFeatureVisits);  // another client of the player
  bench.server.received(2, Move{pose_at(60)}, bench.now());
  bench.server.people().note_places();
  const auto place = [&] {
    return bench.server.people().places().find(key_pair_of(seed_of(1)).public_key);
  };
  CHECK(place() == pose_at(60));
  bench.server.disconnected(1);
  CHECK(place() == pose_at(60));
  bench.server.received(2, Move{pose_at(70)}, bench.now());
  bench.server.disconnected(2);
  CHECK(place() == pose_at(70));
}

TEST_CASE("places are saved from time to time, only if they have changed", "[world][places]") {
  FeatureBench bench;
  bench.tick(60'000'000);
  CHECK(bench.environment.states.empty());
  bench.join_with(1, 1, kFeatureVisits);
  bench.server.received(1, Move{pose_at(40)}, bench.now());
  bench.tick(60'000'000);
  REQUIRE(bench.environment.states.size() == 1);
  const PublicKey key = key_pair_of(seed_of(1)).public_key;
  CHECK(bench.environment.states[0].places == std::vector<LastPlace>{{key, pose_at(40)}});
  bench.server.received(1, Ping{1}, bench.now());
  bench.tick(60'000'000);
  CHECK(bench.environment.states.size() == 1);
  WorldStart start;
  start.saved = bench.environment.states[0];
  FeatureBench next(config(), start);
  next.join_with(1, 1, kFeatureVisits);
  CHECK(next.environment.messages<SessionAccepted>(1, kEdge).at(0).place == pose_at(40));
}

}  // namespace runstone::test
