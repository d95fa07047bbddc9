// Calls of runstone.h on a client, without those on its events.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "bindings/c/buffer.hpp"
#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/client_handle.hpp"
#include "bindings/c/edits_handle.hpp"
#include "bindings/c/runstone.h"
#include "bindings/c/versioned.hpp"
#include "bindings/c/visibility_handle.hpp"
#include "common/core/material_row.hpp"
#include "common/mesh/mesh_materials.hpp"

using namespace runstone;
using namespace runstone::c_interface;

namespace runstone::c_interface {

void refuse_as(const ClientRefusal& refusal) {
  const auto status = static_cast<runstone_status>(static_cast<int>(refusal.code) + 1);
  throw RefusedCall{keep_words(status, "%s", refusal.text.c_str())};
}

}  // namespace runstone::c_interface

namespace {

void take(const Result<void, ClientRefusal>& done) {
  if (!done) refuse_as(done.error());
}

std::string text_or(const char* text, std::string otherwise = {}) {
  return text == nullptr ? std::move(otherwise) : std::string(text);
}

std::uint8_t radius_of_view(std::uint32_t radius) {
  check_at_most(radius, std::uint32_t{64}, "radius", "is larger than 64 chunks");
  return static_cast<std::uint8_t>(radius);
}

WorldClientOptions options_of(const runstone_client_options& from) {
  WorldClientOptions out;
  out.server = &given(from.server, "server");
  out.name = text_or(from.name, out.name);
  out.invite = text_or(from.invite);
  out.password = text_or(from.password);
  out.key_file = text_or(from.key_file);
  if (from.key_seed != nullptr) {
    out.key_seed.emplace();
    std::copy_n(from.key_seed, out.key_seed->size(), out.key_seed->begin());
  }
  check_at_most(from.encryption, std::uint32_t{RUNSTONE_ENCRYPTION_NONE}, "encryption",
                "is unknown");
  out.encryption = static_cast<Encryption>(from.encryption);
  out.authorities_file = text_or(from.authorities_file);
  out.view_radius = radius_of_view(from.view_radius);
  out.view_radius_vertical = radius_of_view(from.view_radius_vertical);
  out.memory_mib = from.memory_mib;
  out.cache_folder = text_or(from.cache_folder);
  out.cache_mib = from.cache_mib;
  if (from.wake != nullptr)
    out.wake = [wake = from.wake, context = from.wake_context] { wake(context); };
  return out;
}

ClientPlace place_from(const runstone_place& from) {
  return {{from.at.x, from.at.y, from.at.z}, from.yaw_degrees, from.pitch_degrees};
}
runstone_place place_to(const ClientPlace& from) {
  return {{from.at.x, from.at.y, from.at.z}, from.yaw_degrees, from.pitch_degrees};
}

const MaterialRow& row_of(runstone_client* client, std::uint32_t material) {
  const auto& rows = live(client, "client").client.materials();
  if (material >= rows.size()) refuse(RUNSTONE_NOT_FOUND, "material", "is not in the world");
  return rows[material];
}

}  // namespace

runstone_status runstone_client_default_options(runstone_client_options* out) {
  return answer([&] {
    const WorldClientOptions options;
    runstone_client_options from{};
    from.encryption = static_cast<std::uint32_t>(options.encryption);
    from.view_radius = options.view_radius;
    from.view_radius_vertical = options.view_radius_vertical;
    from.memory_mib = options.memory_mib;
    from.cache_mib = options.cache_mib;
    fill_versioned(versioned(out, "out"), from);
  });
}

runstone_status runstone_client_connect(const runstone_client_options* options,
                                        runstone_client** out) {
  return answer([&] {
    output(out, "out");
    auto client = WorldClient::connect(options_of(versioned(options, "options")));
    if (!client)
      throw RefusedCall{keep_words(RUNSTONE_BAD_ARGUMENT, "options: %s", client.error().c_str())};
    create(out, *std::move(client));
  });
}

runstone_status runstone_client_free(runstone_client* client) {
  return free_handle(client, "client");
}

runstone_status runstone_client_close(runstone_client* client) {
  return answer([&] { live(client, "client").client.close(); });
}

runstone_status runstone_client_step(runstone_client* client, uint32_t* has_more) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    of.step();
    if (has_more != nullptr) *has_more = of.has_more() ? 1 : 0;
  });
}

runstone_status runstone_client_wait(runstone_client* client, uint32_t milliseconds) {
  return answer([&] { live(client, "client").client.wait(milliseconds); });
}

runstone_status runstone_client_outdated(runstone_client* client, size_t* count) {
  return answer([&] {
    const std::size_t outdated = live(client, "client").client.outdated_count();
    given(count, "count") = outdated;
  });
}

runstone_status runstone_client_state(runstone_client* client, uint32_t* state,
                                      uint32_t* is_complete) {
  return answer([&] {
    const WorldClient& of = live(client, "client").client;
    given(state, "state") = static_cast<std::uint32_t>(of.state());
    if (is_complete != nullptr) *is_complete = of.is_complete() ? 1 : 0;
  });
}

runstone_status runstone_client_world(runstone_client* client, runstone_world_info* out) {
  return answer([&] {
    const auto& world = live(client, "client").client.world();
    versioned(out, "out");
    if (!world) refuse(RUNSTONE_NOT_FOUND, "client", "has not joined a world yet");
    runstone_world_info from{};
    from.chunk_edge = static_cast<std::uint32_t>(world->chunk_edge);
    from.y_min = world->y_min;
    from.y_max = world->y_max;
    from.edit_volume_max = world->edit_volume_max;
    from.spawn = {world->spawn.x, world->spawn.y, world->spawn.z};
    std::copy(world->id.begin(), world->id.end(), from.id);
    from.author = world->author;
    write_text(world->name, from.name);
    write_text(world->server_fingerprint, from.fingerprint);
    fill_versioned(*out, from);
  });
}

runstone_status runstone_client_move(runstone_client* client, const runstone_place* place) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    take(of.move(place_from(given(place, "place"))));
  });
}

runstone_status runstone_client_place(runstone_client* client, runstone_place* out) {
  return answer([&] {
    const ClientPlace& place = live(client, "client").client.place();
    given(out, "out") = place_to(place);
  });
}

runstone_status runstone_client_set_view(runstone_client* client, uint32_t radius,
                                         uint32_t radius_vertical) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    take(of.set_view_radii(radius_of_view(radius), radius_of_view(radius_vertical)));
  });
}

runstone_status runstone_client_submit(runstone_client* client, const runstone_edits* edits,
                                       size_t index, uint64_t action, uint64_t* number) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    const auto submitted = of.submit(edit_at(edits, index), action);
    if (!submitted) refuse_as(submitted.error());
    if (number != nullptr) *number = *submitted;
  });
}

runstone_status runstone_client_submit_delay(runstone_client* client, const runstone_edits* edits,
                                             size_t index, int64_t* wait_us) {
  return answer([&] {
    const TimeUs wait = live(client, "client").client.wait_us(edit_at(edits, index));
    given(wait_us, "wait_us") = wait;
  });
}

runstone_status runstone_client_chat(runstone_client* client, const char* line) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    take(of.chat(&given(line, "line")));
  });
}

runstone_status runstone_client_command(runstone_client* client, const char* text) {
  return answer([&] {
    WorldClient& of = live(client, "client").client;
    take(of.command(&given(text, "text")));
  });
}

runstone_status runstone_client_chunk(runstone_client* client, runstone_pos at,
                                      runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    const auto chunk = live(client, "client").client.chunk({at.x, at.y, at.z});
    if (chunk == nullptr) refuse(RUNSTONE_NOT_FOUND, "at", "is no chunk that is shown");
    create(out, *chunk);
  });
}

runstone_status runstone_client_chunks(runstone_client* client, runstone_pos* out, size_t capacity,
                                       size_t* count) {
  return answer([&] {
    const std::vector<ChunkCoord> chunks = live(client, "client").client.chunks();
    if (!has_room(out, capacity, chunks.size(), count)) return;
    for (const ChunkCoord& at : chunks) *out++ = {at.x, at.y, at.z};
  });
}

runstone_status runstone_client_material_at(runstone_client* client, runstone_pos voxel,
                                            uint16_t* material) {
  return answer([&] {
    const auto found = live(client, "client").client.material_at({voxel.x, voxel.y, voxel.z});
    given(material, "material");
    if (!found) refuse(RUNSTONE_NOT_FOUND, "voxel", "is in no chunk that is shown");
    *material = *found;
  });
}

runstone_status runstone_client_material_count(runstone_client* client, size_t* count) {
  return answer([&] {
    const std::size_t rows = live(client, "client").client.materials().size();
    given(count, "count") = rows;
  });
}

runstone_status runstone_client_material(runstone_client* client, uint32_t material,
                                         runstone_material_info* out) {
  return answer([&] {
    live(client, "client");
    versioned(out, "out");
    const MaterialRow& row = row_of(client, material);
    runstone_material_info from{};
    from.visibility = static_cast<std::uint32_t>(row.visibility);
    from.is_cube = row.shape.is_cube() ? 1 : 0;
    std::copy(row.colour.begin(), row.colour.end(), from.colour);
    write_text(row.name, from.name);
    fill_versioned(*out, from);
  });
}

runstone_status runstone_client_find_material(runstone_client* client, const char* name,
                                              uint16_t* material) {
  return answer([&] {
    const WorldClient& of = live(client, "client").client;
    const auto found = of.find_material(&given(name, "name"));
    given(material, "material");
    if (!found) refuse(RUNSTONE_NOT_FOUND, "name", "is of no material of the world");
    *material = *found;
  });
}

runstone_status runstone_client_visibility(runstone_client* client, runstone_visibility** out) {
  return answer([&] {
    output(out, "out");
    create(out, live(client, "client").client.mesh_materials());
  });
}

runstone_status runstone_client_players(runstone_client* client, runstone_player* out,
                                        size_t capacity, size_t* count) {
  return answer([&] {
    const std::vector<PlayerInfo> players = live(client, "client").client.players();
    if (!has_room(out, capacity, players.size(), count)) return;
    for (const PlayerInfo& player : players) {
      runstone_player from{};
      from.author = player.author;
      if (player.place) {
        from.has_place = 1;
        from.place = place_to(*player.place);
      }
      write_text(player.name, from.name);
      write_text(player.role, from.role);
      *out++ = from;
    }
  });
}
