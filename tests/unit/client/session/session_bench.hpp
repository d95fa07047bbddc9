// SessionBench: a client session, and the server that the test plays for it.
#pragma once
#include <catch2/catch.hpp>

#include "client/session/client_session.hpp"
#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/codec/test_keys.hpp"

namespace runstone::test::session_bench {

using runstone::test::chunks_of;

inline constexpr std::int32_t kEdge = 16;
inline constexpr TimeUs kClockLead = 5'000'000;  // server clock minus client clock

inline SessionConfig config() {
  SessionConfig out;
  out.keys = keys(1);
  out.name = "ada";
  out.instance = 42;
  out.view = {1, {0, 0, 0}, 1, 1};
  return out;
}

/// The server, played by the test.
struct Server {
  KeyPair keys_of_server = keys(9);
  WorldId world_id{1, 2, 3};
  Hello hello;
  Welcome welcome;
  ClientSequence resolved = 0;
  EditBudget edit_budget;
  std::uint64_t features = 0;
  std::uint8_t tile_levels_max = kTileLevelMax;
  AuthorityModel world{kEdge, 3};

  Welcome make_welcome() {
    welcome = {};
    welcome.world_id = world_id;
    welcome.epoch = world.epoch();
    welcome.durable = welcome.head = world.head();
    welcome.chunk_edge = kEdge;
    welcome.materials = default_material_table();
    welcome.server_key = keys_of_server.public_key;
    welcome.challenge = {7};
    welcome.view_radius_max = 8;
    welcome.edit_volume_max = 1000;
    welcome.edit_budget = edit_budget;
    welcome.features = features;
    welcome.tile_levels_max = tile_levels_max;
    welcome.signature = sign(keys_of_server, server_transcript(hello, welcome, std::nullopt));
    return welcome;
  }
};

template <class T>
std::vector<T> take(const std::vector<Message>& messages) {
  std::vector<T> out;
  for (const Message& message : messages) {
    if (const auto* wanted = std::get_if<T>(&message)) out.push_back(*wanted);
  }
  return out;
}

struct SessionBench {
  void receive(Message message) { session.receive(std::move(message), {now, now, now}); }
  std::vector<Message> sent() { return session.take_outgoing(); }

  void greet() {
    session.connected({5}, std::nullopt, now);
    auto out = sent();
    const auto hellos = take<Hello>(out);
    REQUIRE(hellos.size() == 1);
    server.hello = hellos[0];
  }
  std::vector<Message> open() {
    greet();
    receive(server.make_welcome());
    auto out = sent();
    const auto proofs = take<ClientAuth>(out);
    REQUIRE(proofs.size() == 1);
    CHECK(verify(server.hello.key, client_transcript(server.hello, server.welcome, std::nullopt),
                 proofs[0].signature));
    receive(SessionAccepted{6, server.resolved});
    REQUIRE(session.is_open());
    return sent();
  }
  void pong() { receive(Pong{now - 200, now - 100 + kClockLead}); }

  Server server;
  ClientSession session{config()};
  TimeUs now = 1'000'000;
};

inline EditDescriptor set(VoxelPos at, Material material) { return {SetVoxel{at}, {}, material}; }

}  // namespace runstone::test::session_bench
