// Calls of runstone_session.h.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>

#include "bindings/c/chunk_handle.hpp"
#include "bindings/c/mesh_handle.hpp"
#include "bindings/c/versioned.hpp"
#include "bindings/web/carried_session.hpp"
#include "bindings/web/runstone_session.h"
#include "client/session/join_check.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/materials/material_table.hpp"

using namespace runstone;
using namespace runstone::c_interface;

struct runstone_session : Handle<0x73736573> {
  explicit runstone_session(const CarriedPlayer& player) : carried(player) {}

  CarriedSession carried;
  CarriedNotice notice;  // given last
};

namespace {

constexpr double kReachMax = 512;

TimeUs us_of(double now_ms) {
  // No clock of a browser goes beyond 2^50 us.
  if (!(now_ms >= 0 && now_ms < 1e12)) refuse(RUNSTONE_BAD_ARGUMENT, "now_ms", "is no time");
  return static_cast<TimeUs>(now_ms * 1000);
}

WorldPos position_of(const runstone_vec& at, const char* name) {
  for (const double along : {at.x, at.y, at.z}) {
    if (!(std::abs(along) < kWorldLimit))
      refuse(RUNSTONE_BAD_ARGUMENT, name, "is outside the world");
  }
  return {at.x, at.y, at.z};
}

/// Refuses a call with words that are made at run time.
[[noreturn]] void refuse_with(runstone_status status, const std::string& words) {
  throw RefusedCall{keep_words(status, "%s", words.c_str())};
}

}  // namespace

runstone_status runstone_session_create(const uint8_t seed[32], const char* name,
                                        const char* ticket, uint32_t instance, uint32_t radius_h,
                                        uint32_t radius_v, runstone_session** out) {
  return answer([&] {
    output(out, "out");
    CarriedPlayer player;
    std::memcpy(player.seed.data(), &given(seed, "seed"), player.seed.size());
    player.name = &given(name, "name");
    player.ticket = &given(ticket, "ticket");
    // The encoder of messages requires that name and ticket pass these checks.
    if (const auto right = check_player_name(player.name); !right)
      refuse_with(RUNSTONE_BAD_ARGUMENT, "name: " + right.error());
    if (const auto right = check_ticket(player.ticket); !right)
      refuse_with(RUNSTONE_BAD_ARGUMENT, "ticket: " + right.error());
    if (instance == 0) refuse(RUNSTONE_BAD_ARGUMENT, "instance", "is 0");
    player.instance = instance;
    check_at_most(std::max(radius_h, radius_v), std::uint32_t{kCarriedRadiusMax}, "radius",
                  "is above 32 chunks");
    player.radius_h = static_cast<std::uint8_t>(radius_h);
    player.radius_v = static_cast<std::uint8_t>(radius_v);
    create(out, player);
  });
}

runstone_status runstone_session_free(runstone_session* session) {
  return free_handle(session, "session");
}

runstone_status runstone_session_connected(runstone_session* session, const uint8_t nonce[32],
                                           double now_ms) {
  return answer([&] {
    CarriedSession& to = live(session, "session").carried;
    Nonce fresh;
    std::memcpy(fresh.data(), &given(nonce, "nonce"), fresh.size());
    to.connected(fresh, us_of(now_ms));
  });
}

runstone_status runstone_session_disconnected(runstone_session* session) {
  return answer([&] { live(session, "session").carried.disconnected(); });
}

runstone_status runstone_session_receive(runstone_session* session, const uint8_t* bytes,
                                         size_t count, double now_ms) {
  return answer([&] {
    CarriedSession& to = live(session, "session").carried;
    if (count == 0) return;
    const auto taken = to.receive({&given(bytes, "bytes"), count}, us_of(now_ms));
    if (!taken) refuse("bytes of the server", taken.error());
  });
}

runstone_status runstone_session_step(runstone_session* session, double now_ms) {
  return answer([&] { live(session, "session").carried.step(us_of(now_ms)); });
}

runstone_status runstone_session_next_frame(runstone_session* session, const uint8_t** bytes,
                                            size_t* count) {
  return answer([&] {
    CarriedSession& from = live(session, "session").carried;
    given(bytes, "bytes");
    given(count, "count");
    const ByteView frame = from.next_frame();
    *bytes = frame.data();
    *count = frame.size();
  });
}

runstone_status runstone_session_get_info(const runstone_session* session,
                                          runstone_session_info* out) {
  return answer([&] {
    const CarriedSession& carried = live(session, "session").carried;
    const ClientSession& of = carried.session();
    versioned(out, "out");
    runstone_session_info info{};
    info.is_open = of.is_open() ? 1 : 0;
    info.wants_close = carried.wants_close() ? 1 : 0;
    info.is_loaded = of.is_open() && of.loaded() ? 1 : 0;
    info.edge = static_cast<std::uint32_t>(of.replica().chunk_edge());
    info.author = static_cast<std::uint32_t>(of.author());
    info.chunks = static_cast<std::uint32_t>(of.replica().confirmed_count());
    info.unmeshed = static_cast<std::uint32_t>(carried.unmeshed_count());
    info.pending = static_cast<std::uint32_t>(of.replica().local_edits().pending_count());
    info.has_place = of.place() ? 1 : 0;
    WorldPos place;
    if (of.welcome()) {
      info.materials = static_cast<std::uint32_t>(of.welcome()->materials.size());
      place = of.welcome()->spawn;
    }
    if (of.place()) place = of.place()->at;
    info.place = {place.x, place.y, place.z};
    fill_versioned(*out, info);
  });
}

runstone_status runstone_session_next_notice(runstone_session* session, uint32_t* kind,
                                             uint32_t* number, const char** text,
                                             size_t* text_bytes) {
  return answer([&] {
    runstone_session& from = live(session, "session");
    given(kind, "kind") = 0;
    given(number, "number");
    given(text, "text");
    given(text_bytes, "text_bytes");
    auto next = from.carried.next_notice();
    if (!next) return;
    from.notice = *std::move(next);
    *kind = static_cast<std::uint32_t>(from.notice.kind);
    *number = from.notice.number;
    *text = from.notice.text.data();
    *text_bytes = from.notice.text.size();
  });
}

runstone_status runstone_session_get_material(const runstone_session* session, uint32_t material,
                                              runstone_session_material* out, const char** name,
                                              size_t* name_bytes) {
  return answer([&] {
    const auto& welcome = live(session, "session").carried.session().welcome();
    versioned(out, "out");
    given(name, "name");
    given(name_bytes, "name_bytes");
    if (!welcome || material >= welcome->materials.size())
      refuse(RUNSTONE_NOT_FOUND, "material", "is not in the table of the world");
    const MaterialInfo& row = welcome->materials[static_cast<Material>(material)];
    runstone_session_material of{};
    of.visibility = static_cast<std::uint32_t>(row.visibility);
    std::copy(row.colour.begin(), row.colour.end(), of.colour);
    of.is_cube = row.shape == Shape{} ? 1 : 0;
    fill_versioned(*out, of);
    *name = row.name.data();
    *name_bytes = row.name.size();
  });
}

runstone_status runstone_session_move(runstone_session* session, runstone_vec eye, double yaw,
                                      double pitch) {
  return answer([&] {
    CarriedSession& moved = live(session, "session").carried;
    const WorldPos to = position_of(eye, "eye");
    if (!std::isfinite(yaw) || !std::isfinite(pitch))
      refuse(RUNSTONE_BAD_ARGUMENT, "yaw or pitch", "is no finite number");
    moved.move(to, yaw, pitch);
  });
}

runstone_status runstone_session_edit(runstone_session* session, const uint8_t* bytes, size_t count,
                                      double now_ms, uint32_t* number) {
  return answer([&] {
    CarriedSession& in = live(session, "session").carried;
    given(number, "number");
    if (count == 0) refuse(RUNSTONE_BAD_ARGUMENT, "bytes", "are none");
    const auto edit = decode_voxel_edit({&given(bytes, "bytes"), count});
    if (!edit) refuse("bytes", edit.error());
    const auto seq = in.edit(*edit, us_of(now_ms));
    if (!seq) refuse_with(RUNSTONE_NOT_PERMITTED, seq.error());
    *number = static_cast<std::uint32_t>(*seq);
  });
}

runstone_status runstone_session_chat(runstone_session* session, const char* text,
                                      size_t text_bytes) {
  return answer([&] {
    CarriedSession& in = live(session, "session").carried;
    const auto sent = in.chat({&given(text, "text"), text_bytes});
    if (!sent) refuse_with(RUNSTONE_NOT_PERMITTED, sent.error());
  });
}

runstone_status runstone_session_command(runstone_session* session, const char* text,
                                         size_t text_bytes) {
  return answer([&] {
    CarriedSession& in = live(session, "session").carried;
    const auto sent = in.command({&given(text, "text"), text_bytes});
    if (!sent) refuse_with(RUNSTONE_NOT_PERMITTED, sent.error());
  });
}

runstone_status runstone_session_leave(runstone_session* session) {
  return answer([&] { live(session, "session").carried.leave(); });
}

runstone_status runstone_session_next_mesh(runstone_session* session, runstone_mesh* mesh,
                                           runstone_pos* at, uint32_t* has_mesh) {
  return answer([&] {
    CarriedSession& from = live(session, "session").carried;
    runstone_mesh& to = live(mesh, "mesh");
    given(at, "at");
    given(has_mesh, "has_mesh") = 0;
    const auto next = from.next_mesh();
    if (!next) return;
    // The quads belong to no handle of a chunk.
    to.of_chunk = 0;
    to.has_occlusion = false;
    *at = {next->at.x, next->at.y, next->at.z};
    if (next->mesh)
      to.quads = *next->mesh;
    else
      to.quads.clear();
    *has_mesh = next->mesh ? 1 : 2;
  });
}

runstone_status runstone_session_chunk(const runstone_session* session, runstone_pos at,
                                       runstone_chunk** out) {
  return answer([&] {
    output(out, "out");
    const ShownPtr shown =
        live(session, "session").carried.session().replica().shown({0, {at.x, at.y, at.z}});
    if (!shown) refuse(RUNSTONE_NOT_FOUND, "chunk", "is not held");
    create(out, *shown);
  });
}

runstone_status runstone_session_get(const runstone_session* session, runstone_pos at,
                                     uint16_t* material, uint32_t* is_known) {
  return answer([&] {
    const Replica& replica = live(session, "session").carried.session().replica();
    given(material, "material") = 0;
    given(is_known, "is_known") = 0;
    if (replica.chunk_edge() == 0) return;
    const auto shown = replica.shown_at({at.x, at.y, at.z});
    if (!shown) return;
    *material = *shown;
    *is_known = 1;
  });
}

runstone_status runstone_session_pick(const runstone_session* session, runstone_vec eye,
                                      runstone_vec direction, double reach, runstone_ray* out) {
  return answer([&] {
    const CarriedSession& in = live(session, "session").carried;
    const WorldPos from = position_of(eye, "eye");
    const double length = std::hypot(direction.x, direction.y, direction.z);
    if (!(length > 0 && std::isfinite(length)))
      refuse(RUNSTONE_BAD_ARGUMENT, "direction", "has no length");
    if (!(reach >= 0 && reach <= kReachMax))
      refuse(RUNSTONE_BAD_ARGUMENT, "reach", "is not 0 to 512 voxels");
    versioned(out, "out");
    runstone_ray ray{};
    ray.direction = RUNSTONE_DIRECTION_NONE;
    const LookDirection look{direction.x / length, direction.y / length, direction.z / length};
    if (const auto hit = in.pick(from, look, reach)) {
      ray.is_hit = 1;
      ray.distance = hit->distance;
      if (hit->face) ray.direction = static_cast<std::uint32_t>(*hit->face);
      ray.voxel = {hit->voxel.x, hit->voxel.y, hit->voxel.z};
      ray.material = hit->material;
    }
    fill_versioned(*out, ray);
  });
}
