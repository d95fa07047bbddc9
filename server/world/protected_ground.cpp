#include "server/world/protected_ground.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "protocol/codec/key_fingerprint.hpp"
#include "server/world/quotas.hpp"
#include "server/world/rights_handlers.hpp"

namespace runstone {
namespace {

static_assert(kGroundNameBytesMax == kRightsNameBytesMax);
static_assert(kGroundPriorityMax == kBoxPriorityMax);

using Box = const Decided<ProtectedBox>*;

bool has_ground(const WorldSession& session) {
  return !session.is_relayed && session.state == SessionStage::open &&
         (session.features & kFeatureRights) != 0;
}

Permissions permissions_of(const WorldState& world, const PublicKey& key) {
  const Role& role = world.rights.role_of(key);
  Permissions out;
  out.role = role.name;
  out.edit_budget = edit_budget_of(world, key);
  if (world.config.operators.contains(key)) {
    out.rights = RightSet::all().bits();
    return out;
  }
  out.rights = world.rights.rights_in_force(key, rights_time(world)).bits();
  out.edit_volume_max = role.edit_volume_max;
  if (auto frozen = freeze_text(world, key)) out.edits_refused = *std::move(frozen);
  return out;
}

/// Returns when the next restriction of the player ends, or 0 if none ends by itself.
TimeUs restricted_until(const WorldState& world, const PublicKey& key) {
  TimeUs first_us = 0;
  for (const RestrictionKind kind : {RestrictionKind::mute, RestrictionKind::freeze}) {
    const auto* found = world.rights.restriction(kind, key, rights_time(world));
    if (found == nullptr || found->value.until_us == 0) continue;
    const TimeUs until_us = found->value.until_us;
    first_us = first_us == 0 ? until_us : std::min(first_us, until_us);
  }
  return first_us;
}

/// Marks what differs from what the session was sent.
void refresh_permissions(WorldState& world, WorldSession& mine) {
  SentGround& sent = mine.ground;
  sent.restricted_until_us = restricted_until(world, mine.key);
  sent.are_permissions_due = sent.permissions != permissions_of(world, mine.key);
  // The player's role also decides which boxes admit the player.
  if (sent.are_permissions_due) sent.are_boxes_due = true;
}

void send_permissions(WorldState& world, SessionId session) {
  SentGround& sent = world.find(session)->ground;
  Permissions now = permissions_of(world, world.find(session)->key);
  if (!send_or_skip(world, session, encode_message(now))) return;
  sent.permissions = std::move(now);
  sent.are_permissions_due = false;
}

/// Returns the chunks up to these distances from the centre, as voxels within the world.
VoxelBox cuboid_around(ChunkCoord centre, std::int32_t radius_h, std::int32_t radius_v,
                       std::int32_t edge) {
  const auto range = [edge](std::int32_t at, std::int32_t radius) {
    const std::int64_t min = (std::int64_t{at} - radius) * edge;
    const std::int64_t max = (std::int64_t{at} + radius + 1) * edge;
    const auto in_world = [](std::int64_t c) {
      return static_cast<std::int32_t>(
          std::clamp<std::int64_t>(c, -std::int64_t{kWorldLimit}, kWorldLimit));
    };
    return std::pair(in_world(min), in_world(max));
  };
  const auto [x0, x1] = range(centre.x, radius_h);
  const auto [y0, y1] = range(centre.y, radius_v);
  const auto [z0, z1] = range(centre.z, radius_h);
  return {{x0, y0, z0}, {x1, y1, z1}};
}

/// Returns the ground of a session's view, or an empty box if there is no view.
VoxelBox ground_of(const WorldState& world, SessionId session) {
  const auto& view = world.interest.find(session)->view();
  if (!view) return {};
  return cuboid_around(view->centre, view->radius_h, view->radius_v, world.config.chunk_edge);
}

/// Returns the boxes that the session should know, and adds the number of visited ones.
std::vector<Box> boxes_near(const WorldState& world, const View& view, std::size_t& visited) {
  std::int32_t radius_h = view.radius_h, radius_v = view.radius_v;
  while (true) {
    const VoxelBox cuboid = cuboid_around(view.centre, radius_h, radius_v, world.config.chunk_edge);
    std::vector<Box> found;
    if (!cuboid.empty()) found = world.rights.some_boxes_in(cuboid, kGroundBoxesMax + 1);
    visited += found.size();
    const bool is_one_chunk = radius_h == 0 && radius_v == 0;
    if (found.size() > kGroundBoxesMax && is_one_chunk) found.resize(kGroundBoxesMax);
    if (found.size() <= kGroundBoxesMax) return found;
    radius_h /= 2;
    radius_v /= 2;
  }
}

std::string owner_text(const WorldState& world, const ProtectedBox& box) {
  if (!box.owner) return "";
  if (auto name = world.players.name_of(*box.owner)) return *std::move(name);
  return key_fingerprint(*box.owner);
}

/// Sends the session the difference between the boxes near its view and those that it was sent.
/// Returns the number of boxes that were compared.
std::size_t send_boxes(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  std::size_t visited = mine.ground.boxes.size();
  std::vector<Box> near;
  if (const auto& view = world.interest.find(session)->view())
    near = boxes_near(world, *view, visited);
  std::sort(near.begin(), near.end(), [](Box a, Box b) { return a->by.seq < b->by.seq; });
  const bool is_operator = world.config.operators.contains(mine.key);
  const Role& role = world.rights.role_of(mine.key);
  ProtectedGround change;
  std::map<Sequence, bool> known;
  for (const Box box : near) {
    const bool is_admitted = is_operator || admits(box->value, mine.key, role);
    known.emplace_hint(known.end(), box->by.seq, is_admitted);
    const auto sent = mine.ground.boxes.find(box->by.seq);
    if (sent != mine.ground.boxes.end() && sent->second == is_admitted) continue;
    change.boxes.push_back({box->by.seq, box->value.box, box->value.priority, is_admitted,
                            box->value.name, owner_text(world, box->value)});
  }
  for (const auto& [seq, was_admitted] : mine.ground.boxes) {
    if (!known.contains(seq)) change.removed.push_back(seq);
  }
  const bool is_empty = change.boxes.empty() && change.removed.empty();
  if (is_empty || send_or_skip(world, session, encode_message(change))) {
    mine.ground.boxes = std::move(known);
    mine.ground.are_boxes_due = false;
  }
  return visited + 1;
}

}  // namespace

void start_ground(WorldState& world, SessionId session) {
  WorldSession& mine = *world.find(session);
  if (!has_ground(mine)) return;
  refresh_permissions(world, mine);
  send_permissions(world, session);
}

void mark_ground(WorldState& world, SessionId session) {
  world.find(session)->ground.are_boxes_due = true;
}

void add_changed_ground(const RightsState& rights, const RightsChange& change,
                        std::vector<VoxelBox>& ground) {
  const auto add_box_of = [&](const std::string& name) {
    if (const auto* box = rights.find_box(name)) ground.push_back(box->value.box);
  };
  if (const auto* protect = std::get_if<Protect>(&change)) {
    add_box_of(protect->box.name);
    ground.push_back(protect->box.box);
  } else if (const auto* unprotect = std::get_if<Unprotect>(&change)) {
    add_box_of(unprotect->box);
  }
}

void rights_changed(WorldState& world, const std::vector<VoxelBox>& ground) {
  world.player_list_changed = true;  // it has the roles
  for (auto& [id, session] : world.sessions) {
    if (!has_ground(session)) continue;
    refresh_permissions(world, session);
    const VoxelBox seen = ground_of(world, id);
    const bool is_near =
        !seen.empty() && std::any_of(ground.begin(), ground.end(),
                                     [&](const VoxelBox& box) { return overlaps(box, seen); });
    if (is_near) session.ground.are_boxes_due = true;
  }
}

void send_due_ground(WorldState& world) {
  std::vector<SessionId> due;
  for (auto& [id, session] : world.sessions) {
    if (!has_ground(session)) continue;
    const TimeUs until_us = session.ground.restricted_until_us;
    if (until_us != 0 && rights_time(world) >= until_us) refresh_permissions(world, session);
    if (session.ground.are_permissions_due) send_permissions(world, id);
    if (session.ground.are_boxes_due && !session.history) due.push_back(id);
  }
  // Sessions behind the one served last come first, so that every session is served.
  std::rotate(due.begin(), std::upper_bound(due.begin(), due.end(), world.ground_sent_last),
              due.end());
  std::size_t compared = 0;
  for (const SessionId id : due) {
    if (compared >= kGroundBoxesPerTick) return;
    world.ground_sent_last = id;
    compared += send_boxes(world, id);
  }
}

}  // namespace runstone
