// The client of the C interface against a server.
#include <array>
#include <catch2/catch.hpp>
#include <chrono>
#include <cstring>
#include <string>
#include <vector>

#include "common/core/text.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

runstone_client_options default_options(const std::string& server) {
  runstone_client_options out{};
  out.struct_size = sizeof out;
  REQUIRE(runstone_client_default_options(&out) == RUNSTONE_OK);
  out.server = server.c_str();
  out.view_radius = 2;
  out.view_radius_vertical = 1;
  return out;
}

/// A client, and the last events that it drained.
struct CPlayer {
  explicit CPlayer(const runstone_client_options& options)
      : client(owned<runstone_client>(
            [&](runstone_client** out) { return runstone_client_connect(&options, out); })) {}

  runstone_client* get() const { return client.get(); }
  std::string text(std::size_t index) const {
    const auto characters = fetched<char>([&](auto* out, std::size_t room, std::size_t* n) {
      return runstone_client_event_text(get(), index, out, room, n);
    });
    REQUIRE_FALSE(characters.empty());
    REQUIRE(characters.back() == '\0');
    return characters.data();
  }
  /// Steps until `handle(index, event)` returns true for an event, for at most a minute.
  template <class F>
  bool step_until(F&& handle) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    bool is_reached = false;
    while (!is_reached && std::chrono::steady_clock::now() < deadline) {
      REQUIRE(runstone_client_wait(get(), 10) == RUNSTONE_OK);
      REQUIRE(runstone_client_step(get(), nullptr) == RUNSTONE_OK);
      std::array<runstone_event, 3> events{};  // few, so that some wait for the next call
      std::size_t count = events.size();
      while (count == events.size()) {
        REQUIRE(runstone_client_drain(get(), 4, events.data(), sizeof events[0], events.size(),
                                      &count) == RUNSTONE_OK);
        for (std::size_t i = 0; i < count; ++i) {
          REQUIRE(events[i].struct_size == sizeof events[i]);
          is_reached = handle(i, events[i]) || is_reached;
        }
      }
    }
    return is_reached;
  }

  Owned<runstone_client> client;
};

Owned<runstone_edits> edit_of_voxel(runstone_pos at, std::uint16_t material) {
  auto edits = owned<runstone_edits>(runstone_edits_create);
  const runstone_brush brush{sizeof brush, RUNSTONE_MASK_EVERYTHING, 0, material};
  REQUIRE(runstone_edits_add_voxel(edits.get(), at, &brush) == RUNSTONE_OK);
  return edits;
}

std::uint32_t is_equal(const runstone_chunk* a, const runstone_chunk* b) {
  std::uint32_t out = 2;
  REQUIRE(runstone_chunk_equal(a, b, &out) == RUNSTONE_OK);
  return out;
}

}  // namespace

TEST_CASE("a program in C joins, meshes what it is shown, edits and chats", "[c_interface]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder / "world"), flat_creation());
  const std::string address = "127.0.0.1:" + std::to_string(server->port());
  CPlayer player(default_options(address));
  runstone_world_info world{};
  world.struct_size = sizeof world;
  CHECK(runstone_client_world(player.get(), &world) == RUNSTONE_NOT_FOUND);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  std::size_t meshed = 0, quads = 0;
  const auto mesh_event = [&](std::size_t index, const runstone_event& event) {
    if (event.kind != RUNSTONE_EVENT_CHUNK_CHANGED) return;
    ++meshed;
    REQUIRE(runstone_client_mesh(player.get(), index, mesh.get()) == RUNSTONE_OK);
    std::size_t count = 0;
    REQUIRE(runstone_mesh_quads(mesh.get(), 0, nullptr, 0, &count) == RUNSTONE_OK);
    quads += count;
    // The handles of the chunk and its neighbours give the same quads.
    runstone_chunk* chunk = nullptr;
    std::array<runstone_chunk*, 6> beside{};
    REQUIRE(runstone_client_take_chunk(player.get(), index, &chunk, beside.data()) == RUNSTONE_OK);
    const Owned<runstone_chunk> owner(chunk);
    std::array<Owned<runstone_chunk>, 6> owners;
    for (std::size_t d = 0; d < 6; ++d) owners[d].reset(beside[d]);
    const auto visibility = owned<runstone_visibility>(
        [&](runstone_visibility** out) { return runstone_client_visibility(player.get(), out); });
    REQUIRE(runstone_mesh_chunk(mesh.get(), chunk, beside.data(), nullptr, visibility.get()) ==
            RUNSTONE_OK);
    std::size_t again = 0;
    REQUIRE(runstone_mesh_quads(mesh.get(), 0, nullptr, 0, &again) == RUNSTONE_OK);
    CHECK(again == count);
    const auto shown = owned<runstone_chunk>(
        [&](runstone_chunk** out) { return runstone_client_chunk(player.get(), event.at, out); });
    CHECK(is_equal(shown.get(), chunk) == 1);
  };
  std::uint32_t state = 9, is_complete = 0;
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& event) {
    mesh_event(index, event);
    REQUIRE(runstone_client_state(player.get(), &state, &is_complete) == RUNSTONE_OK);
    return is_complete == 1;
  }));
  CHECK(state == RUNSTONE_CLIENT_OPEN);
  REQUIRE(runstone_client_world(player.get(), &world) == RUNSTONE_OK);
  CHECK(world.chunk_edge == 16);
  CHECK(std::string(world.name) == "builder");
  CHECK(world.fingerprint[0] != '\0');
  CHECK(world.edit_volume_max > 0);

  // An edit is shown at once, and confirmed.
  runstone_place place{};
  REQUIRE(runstone_client_place(player.get(), &place) == RUNSTONE_OK);
  const runstone_pos at{static_cast<std::int32_t>(place.at.x),
                        static_cast<std::int32_t>(place.at.y),
                        static_cast<std::int32_t>(place.at.z)};
  const auto edit = edit_of_voxel(at, 2);
  std::uint64_t number = 0;
  std::int64_t wait_us = -1;
  CHECK(runstone_client_submit_delay(player.get(), edit.get(), 0, &wait_us) == RUNSTONE_OK);
  CHECK(wait_us == 0);
  CHECK(runstone_client_submit(player.get(), edit.get(), 1, 0, &number) == RUNSTONE_BAD_ARGUMENT);
  REQUIRE(runstone_client_submit(player.get(), edit.get(), 0, RUNSTONE_NEW_ACTION, &number) ==
          RUNSTONE_OK);
  std::uint16_t material = 0;
  REQUIRE(runstone_client_material_at(player.get(), at, &material) == RUNSTONE_OK);
  CHECK(material == 2);
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& event) {
    mesh_event(index, event);
    return event.kind == RUNSTONE_EVENT_EDIT_CONFIRMED && event.edit == number &&
           event.sequence > 0;
  }));
  CHECK(meshed > 4);
  CHECK(quads > 0);

  // A second player sees the edit, and both chat.
  runstone_client_options options = default_options(address);
  options.name = "grace";
  CPlayer other(options);
  REQUIRE(other.step_until([&](std::size_t, const runstone_event&) {
    std::uint16_t seen = 0;
    return runstone_client_material_at(other.get(), at, &seen) == RUNSTONE_OK && seen == 2;
  }));
  REQUIRE(runstone_client_chat(other.get(), "hello") == RUNSTONE_OK);
  REQUIRE(runstone_client_step(other.get(), nullptr) == RUNSTONE_OK);
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& event) {
    return event.kind == RUNSTONE_EVENT_CHAT && event.detail == RUNSTONE_CHAT_PLAYER &&
           player.text(index) == "hello";
  }));
  const auto players = fetched<runstone_player>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_client_players(player.get(), out, room, n);
  });
  REQUIRE(players.size() == 1);
  CHECK(std::string(players[0].name) == "grace");
  // An edit of the second one names its chunks.
  const auto more = edit_of_voxel({at.x + 1, at.y, at.z}, 1);
  REQUIRE(runstone_client_submit(other.get(), more.get(), 0, 0, nullptr) == RUNSTONE_OK);
  REQUIRE(runstone_client_step(other.get(), nullptr) == RUNSTONE_OK);
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& event) {
    if (event.kind != RUNSTONE_EVENT_OTHERS_EDIT) return false;
    CHECK(event.author == players[0].author);
    return !fetched<runstone_pos>([&](auto* out, std::size_t room, std::size_t* n) {
              return runstone_client_event_chunks(player.get(), index, out, room, n);
            }).empty();
  }));
  REQUIRE(runstone_client_command(player.get(), "no-such-command") == RUNSTONE_OK);
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& event) {
    return event.kind == RUNSTONE_EVENT_COMMAND_DONE && (event.flags & RUNSTONE_FLAG_OK) == 0 &&
           !player.text(index).empty();
  }));

  // Materials by number and by name.
  std::size_t count = 0;
  REQUIRE(runstone_client_material_count(player.get(), &count) == RUNSTONE_OK);
  REQUIRE(count > 2);
  runstone_material_info info{};
  info.struct_size = sizeof info;
  REQUIRE(runstone_client_material(player.get(), 1, &info) == RUNSTONE_OK);
  CHECK(info.visibility == RUNSTONE_OPAQUE);
  REQUIRE(runstone_client_find_material(player.get(), info.name, &material) == RUNSTONE_OK);
  CHECK(material == 1);
  CHECK(runstone_client_find_material(player.get(), "no such", &material) == RUNSTONE_NOT_FOUND);
  CHECK(runstone_client_material(player.get(), 65536, &info) == RUNSTONE_NOT_FOUND);
  const auto chunks = fetched<runstone_pos>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_client_chunks(player.get(), out, room, n);
  });
  CHECK(chunks.size() > 4);
  runstone_chunk* none = nullptr;
  CHECK(runstone_client_chunk(player.get(), {4000, 0, 0}, &none) == RUNSTONE_NOT_FOUND);

  // After close(), received chunks and events stay readable, and no call can send.
  REQUIRE(runstone_client_close(player.get()) == RUNSTONE_OK);
  REQUIRE(runstone_client_close(player.get()) == RUNSTONE_OK);
  CHECK(runstone_client_step(player.get(), nullptr) == RUNSTONE_OK);
  CHECK(runstone_client_wait(player.get(), 0) == RUNSTONE_OK);
  REQUIRE(runstone_client_state(player.get(), &state, nullptr) == RUNSTONE_OK);
  CHECK(state == RUNSTONE_CLIENT_ENDED);
  CHECK(runstone_client_submit(player.get(), edit.get(), 0, 0, nullptr) != RUNSTONE_OK);
  CHECK(runstone_client_chat(player.get(), "late") != RUNSTONE_OK);
  CHECK(std::strlen(runstone_last_error()) > 0);
  CHECK(runstone_client_command(player.get(), "undo") != RUNSTONE_OK);
  REQUIRE(runstone_client_material_at(player.get(), at, &material) == RUNSTONE_OK);
}

TEST_CASE("wrong arguments of a client in C are refused with words", "[c_interface]") {
  const std::string nobody = "127.0.0.1:1";
  runstone_client* out = nullptr;
  const auto refused = [&](const runstone_client_options& options) {
    const runstone_status status = runstone_client_connect(&options, &out);
    return status != RUNSTONE_OK && out == nullptr && std::strlen(runstone_last_error()) > 10;
  };
  runstone_client_options options = default_options(nobody);
  options.struct_size = 8;
  CHECK(refused(options));
  options = default_options(nobody);
  options.server = nullptr;
  CHECK(refused(options));
  options.server = "";
  CHECK(refused(options));
  options = default_options(nobody);
  options.name = "";
  CHECK(refused(options));
  options = default_options(nobody);
  options.encryption = 3;
  CHECK(refused(options));
  options = default_options(nobody);
  options.view_radius = 65;
  CHECK(refused(options));
  options = default_options(nobody);
  options.memory_mib = 1;
  CHECK(refused(options));
  options = default_options(nobody);
  options.key_file = "/no/such/folder/key";
  CHECK(refused(options));
  // Texts that are too long are cut between two characters, wherever these begin.
  for (const std::string begin : {"/no/", "/nos/"}) {
    std::string folder = begin;
    for (int i = 0; i < 200; ++i) folder += "\u00e9";
    const std::string key_file = folder + "/key";
    options.key_file = key_file.c_str();
    CHECK(refused(options));
    CHECK(std::strlen(runstone_last_error()) >= 252);
    CHECK(is_printable_utf8(runstone_last_error()));
  }

  // No server listens: the calls that need a world are refused, and the event has the reason.
  CPlayer player(default_options(nobody));
  const runstone_place place{};
  CHECK(runstone_client_move(player.get(), &place) != RUNSTONE_OK);
  CHECK(runstone_client_set_view(player.get(), 65, 1) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_client_chat(player.get(), "hello") != RUNSTONE_OK);
  runstone_event event{};
  std::size_t count = 7;
  CHECK(runstone_client_drain(player.get(), 1, &event, 8, 1, &count) == RUNSTONE_BAD_ARGUMENT);
  CHECK(count == 0);
  CHECK(runstone_client_drain(player.get(), 1, &event, sizeof event, 0, &count) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_client_event_text(player.get(), 0, nullptr, 0, &count) == RUNSTONE_NOT_FOUND);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  CHECK(runstone_client_mesh(player.get(), 0, mesh.get()) == RUNSTONE_NOT_FOUND);
  REQUIRE(player.step_until([&](std::size_t index, const runstone_event& of) {
    if (of.kind != RUNSTONE_EVENT_CONNECTION_LOST) return false;
    CHECK_FALSE(player.text(index).empty());
    CHECK(runstone_client_mesh(player.get(), index, mesh.get()) == RUNSTONE_NOT_FOUND);
    CHECK(runstone_client_event_chunks(player.get(), index, nullptr, 0, &count) ==
          RUNSTONE_NOT_FOUND);
    return true;
  }));
}
