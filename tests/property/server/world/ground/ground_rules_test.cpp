// What a session is sent about rights suffices to decide as the server does, within its view.
#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "client/replica/known_ground.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/rights/random_rights.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone::test {
namespace {

constexpr VoxelBox kGround = {{-40, -40, -40}, {40, 40, 40}};
constexpr std::uint8_t kPlayers = 3;

PublicKey player_key(std::uint8_t who) { return key_pair_of(seed_of(who)).public_key; }

/// Returns a change about the players of the test that lets them stay.
RightsChange random_player_change(SplitMix64& rng) {
  static constexpr const char* kRoles[] = {kVisitorRole, kBuilderRole, kModeratorRole};
  const PublicKey key = player_key(static_cast<std::uint8_t>(1 + rng.below(kPlayers)));
  switch (rng.below(8)) {
    case 0:
      return GrantRole{key, rng.below(4) == 0 ? "" : kRoles[rng.below(3)]};
    case 1:
      return SetDefaultRole{kRoles[rng.below(3)]};
    case 2:
      return Restrict{RestrictionKind::freeze, key,
                      1'000'000'000 + static_cast<TimeUs>(rng.below(30'000'000)), ""};
    case 3:
      return Lift{RestrictionKind::freeze, key};
    case 4:
      return Unprotect{random_close_box(rng).name};
    default:
      break;
  }
  ProtectedBox box = random_close_box(rng);
  box.box = random_box_in(rng, kGround, 30);
  if (rng.below(3) == 0) box.owner = key;
  if (rng.below(3) == 0) box.members = {key};
  return Protect{box};
}

/// A client that keeps what it was sent.
struct Listener {
  SessionId session = 0;
  std::size_t heard = 0;  // messages of the environment
  View view;
  KnownGround ground;

  void listen(const FakeEnvironment& environment) {
    for (; heard < environment.sent.size(); ++heard) {
      const auto& [to, encoded] = environment.sent[heard];
      if (to != session) continue;
      const auto message = decode_message(Sender::server, encoded.kind, *encoded.bytes, kEdge);
      REQUIRE(message.has_value());
      if (const auto* permissions = std::get_if<Permissions>(&*message))
        ground.receive(*permissions);
      if (const auto* change = std::get_if<ProtectedGround>(&*message))
        REQUIRE(ground.receive(*change).has_value());
    }
  }
};

void join_as(WorldBench& bench, SessionId session, std::uint8_t who) {
  bench.server.connected(session, bench.now(), {});
  Hello hello = bench.hello(who);
  hello.features = kFeatureRights;
  bench.server.received(session, hello, bench.now());
  const auto welcome = bench.environment.messages<Welcome>(session, 0);
  REQUIRE(welcome.size() == 1);
  bench.server.received(session, bench.client_auth(who, hello, welcome[0]), bench.now());
}

/// Returns a box or a sphere within the cuboid of the view.
EditDescriptor random_edit_in(SplitMix64& rng, const View& view) {
  const auto range = [](std::int32_t at, std::int32_t radius) {
    return std::pair((at - radius) * kEdge, (at + radius + 1) * kEdge);
  };
  const auto [x0, x1] = range(view.centre.x, view.radius_h);
  const auto [y0, y1] = range(view.centre.y, view.radius_v);
  const auto [z0, z1] = range(view.centre.z, view.radius_h);
  const VoxelBox place = random_box_in(rng, {{x0, y0, z0}, {x1, y1, z1}}, 6);
  const VoxelPos middle = {(place.min.x + place.max.x) / 2, (place.min.y + place.max.y) / 2,
                           (place.min.z + place.max.z) / 2};
  EditDescriptor edit{FillBox{place}, {}, 1};
  if (rng.below(2) == 0) edit.shape = FillSphere{middle, 0};
  return edit;
}

}  // namespace

TEST_CASE("a session's messages decide about edits in its view as the server does",
          "[world][rights][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  WorldBench bench;
  std::vector<Listener> listeners(kPlayers);
  for (std::uint8_t who = 1; who <= kPlayers; ++who) {
    listeners[who - 1U].session = who;
    join_as(bench, who, who);
  }
  int allowed = 0, refused = 0;
  for (int step = 0; step < 600; ++step) {
    for (auto left = rng.below(3); left > 0; --left)
      static_cast<void>(
          bench.server.changes().change_rights(random_player_change(rng), {}, 0, bench.now()));
    for (Listener& listener : listeners) {
      if (step != 0 && rng.below(4) != 0) continue;
      const auto at = [&rng] { return rng.between(-3, 3); };
      listener.view = {1,
                       {at(), at(), at()},
                       static_cast<std::uint8_t>(rng.below(3)),
                       static_cast<std::uint8_t>(rng.below(3))};
      bench.send_view(listener.session, listener.view);
    }
    bench.environment.full.clear();
    for (Listener& listener : listeners) {
      if (rng.below(4) == 0) bench.environment.full.insert(listener.session);
    }
    bench.tick();
    for (Listener& listener : listeners) {
      const auto who = static_cast<std::uint8_t>(listener.session);
      if (bench.environment.full.contains(listener.session)) continue;
      listener.listen(bench.environment);
      for (int i = 0; i < 10; ++i) {
        const EditDescriptor edit = random_edit_in(rng, listener.view);
        CAPTURE(Catch::rngSeed(), step, int{who}, i);
        const auto by_server = bench.server.rights().edit_refusal(who, edit);
        const auto by_client = listener.ground.refusal(edit);
        REQUIRE(by_client.has_value() == by_server.has_value());
        if (by_client) CHECK(*by_client == *by_server);
        ++(by_client ? refused : allowed);
      }
    }
  }
  CHECK(std::min(allowed, refused) > 1000);
}

}  // namespace runstone::test
