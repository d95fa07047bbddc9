// WorldBench: a world strand with a fake environment, a clock that the test moves, and clients that
// do the handshake.
#pragma once
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "protocol/codec/handshake.hpp"
#include "server/world/world_server.hpp"
#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone::test {

inline constexpr std::uint16_t kEdge = 16;

inline KeySeed seed_of(std::uint8_t n) {
  KeySeed seed{};
  seed.fill(n);
  return seed;
}

inline WorldConfig config() {
  WorldConfig c;
  c.chunk_edge = kEdge;
  c.server_keys = key_pair_of(seed_of(200));
  c.view_radius_max = 4;
  for (int i = 1; i < 5; ++i) {
    MaterialInfo info;
    info.name = "m" + std::to_string(i);
    REQUIRE(c.materials.add(info).has_value());
  }
  return c;
}

struct WorldBench {
  /// `random` is every byte that the server draws.
  explicit WorldBench(WorldConfig c = config(), WorldStart start = {}, std::uint8_t random = 9)
      : server(std::move(c), start, environment,
               [random](std::span<std::uint8_t> out) { std::ranges::fill(out, random); }) {}

  Clocks now() const { return {time_us, time_us + 1'000'000'000 + wall_error_us}; }

  Hello hello(std::uint8_t who, ClientInstance instance = 1) const {
    Hello h;
    h.key = key_pair_of(seed_of(who)).public_key;
    h.instance = instance;
    h.name = "player" + std::to_string(who);
    return h;
  }
  /// Does the handshake as far as client auth, with an invite token.
  void knock(SessionId session, std::uint8_t who, const std::string& ticket) {
    server.connected(session, now());
    const Hello h = hello(who);
    server.received(session, h, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    ClientAuth auth = client_auth(who, h, welcome[0]);
    auth.ticket = ticket;
    server.received(session, auth, now());
  }
  ClientAuth client_auth(std::uint8_t who, const Hello& h, const Welcome& w,
                         const std::optional<ChannelBinding>& binding = std::nullopt) const {
    return {sign(key_pair_of(seed_of(who)), client_transcript(h, w, binding)), {}};
  }
  SessionAccepted join(SessionId session, std::uint8_t who, ClientInstance instance = 1,
                       AddressBlock from = {}, std::uint64_t features = 0) {
    server.connected(session, now(), from);
    Hello h = hello(who, instance);
    h.features = features;
    server.received(session, h, now());
    const auto welcome = environment.messages<Welcome>(session, 0);
    REQUIRE(welcome.size() == 1);
    server.received(session, client_auth(who, h, welcome[0]), now());
    const auto accepted = environment.messages<SessionAccepted>(session, kEdge);
    REQUIRE(accepted.size() == 1);
    return accepted[0];
  }
  /// Sends a view with the number that follows the session's last one.
  void send_view(SessionId session, View v) {
    v.number = ++views[session];
    server.received(session, v, now());
  }
  void view(SessionId session, const View& v) {
    send_view(session, v);
    answer_loads();
  }
  void answer_loads() {
    while (!environment.loads.empty() || server.ground().has_deliveries()) {
      server.ground().deliver_next(now());
      if (environment.loads.empty()) continue;
      const ChunkKey key = environment.loads.front();
      environment.loads.pop_front();
      server.chunk_loaded(key, has_empty_base ? empty_chunk(kEdge) : dotted_chunk(kEdge), now());
    }
  }
  void edit(SessionId session, ClientSequence seq, const EditShape& shape, Material material = 1) {
    server.received(session, EditRequest{seq, 0, {shape, {}, material}}, now());
  }
  void tick(TimeUs later_us = 50'000) {
    time_us += later_us;
    server.tick(now());
    while (server.ground().has_deliveries()) server.ground().deliver_next(now());
  }
  std::vector<Commit> commits(SessionId session) const {
    return environment.messages<Commit>(session, kEdge);
  }

  FakeEnvironment environment;
  TimeUs time_us = 1'000'000;
  TimeUs wall_error_us = 0;                  // how far the wall clock is ahead of the right time
  std::map<SessionId, std::uint32_t> views;  // that each session has sent
  bool has_empty_base = false;  // loaded chunks are uniform; otherwise each is sent as a snapshot
  WorldServer server;
};

inline constexpr View kSmall{1, {0, 0, 0}, 1, 0};  // five chunks
inline const EditShape kAtOrigin = SetVoxel{{1, 1, 1}};

}  // namespace runstone::test
