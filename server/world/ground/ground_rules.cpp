#include "server/world/ground/ground_rules.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

static_assert(kGroundNameBytesMax == kRightsNameBytesMax);
static_assert(kGroundPriorityMax == kBoxPriorityMax);

using Box = const Decided<ProtectedBox>*;

bool has_ground(const Viewer& viewer) {
  return !viewer.session.is_relayed && viewer.session.has(kFeatureRights);
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
VoxelBox ground_of(const GroundBase& base, SessionId session) {
  const auto& view = base.interest.find(session)->view();
  if (!view) return {};
  return cuboid_around(view->centre, view->radius_h, view->radius_v, base.config.chunk_edge);
}

/// Returns the boxes that the session should know, and adds the number of visited ones.
std::vector<Box> boxes_near(const GroundBase& base, const View& view, std::size_t& visited) {
  std::int32_t radius_h = view.radius_h, radius_v = view.radius_v;
  while (true) {
    const VoxelBox cuboid = cuboid_around(view.centre, radius_h, radius_v, base.config.chunk_edge);
    std::vector<Box> found;
    if (!cuboid.empty()) found = base.rights.state().some_boxes_in(cuboid, kGroundBoxesMax + 1);
    visited += found.size();
    const bool is_one_chunk = radius_h == 0 && radius_v == 0;
    if (found.size() > kGroundBoxesMax && is_one_chunk) found.resize(kGroundBoxesMax);
    if (found.size() <= kGroundBoxesMax) return found;
    radius_h /= 2;
    radius_v /= 2;
  }
}

std::string owner_text(const Players& players, const ProtectedBox& box) {
  if (!box.owner) return "";
  if (auto name = players.name_of(*box.owner)) return *std::move(name);
  return key_fingerprint(*box.owner);
}

}  // namespace

Permissions GroundRules::permissions_of(const PublicKey& key) const {
  const Rights& rights = base_.rights;
  const Role& role = rights.state().role_of(key);
  Permissions out;
  out.role = role.name;
  out.edit_budget = base_.quotas.edit_budget_of(key);
  if (rights.is_operator(key)) {
    out.rights = RightSet::all().bits();
    return out;
  }
  out.rights = rights.state().rights_in_force(key, rights.time()).bits();
  out.edit_volume_max = role.edit_volume_max;
  if (auto frozen = rights.freeze_text(key)) out.edits_refused = *std::move(frozen);
  return out;
}

/// Returns when the next restriction of the player ends, or 0 if none ends by itself.
TimeUs GroundRules::restricted_until(const PublicKey& key) const {
  TimeUs first_us = 0;
  for (const RestrictionKind kind : {RestrictionKind::mute, RestrictionKind::freeze}) {
    const auto* found = base_.rights.state().restriction(kind, key, base_.rights.time());
    if (found == nullptr || found->value.until_us == 0) continue;
    const TimeUs until_us = found->value.until_us;
    first_us = first_us == 0 ? until_us : std::min(first_us, until_us);
  }
  return first_us;
}

/// Marks what differs from what the session was sent.
void GroundRules::refresh_permissions(Viewer& viewer) {
  const PublicKey& key = viewer.session.key;
  GroundSent& sent = viewer.ground;
  sent.restricted_until_us = restricted_until(key);
  sent.are_permissions_due = sent.permissions != permissions_of(key);
  // The player's role also decides which boxes admit the player.
  if (sent.are_permissions_due) sent.are_boxes_due = true;
}

void GroundRules::send_permissions(Viewer& viewer) {
  GroundSent& sent = viewer.ground;
  Permissions now = permissions_of(viewer.session.key);
  if (!base_.sessions.send_or_skip(viewer.session, encode_message(now))) return;
  sent.permissions = std::move(now);
  sent.are_permissions_due = false;
}

/// Sends the session the difference between the boxes near its view and those that it was sent.
/// Returns the number of boxes that were compared.
std::size_t GroundRules::send_boxes(Viewer& viewer) {
  const PublicKey& key = viewer.session.key;
  GroundSent& sent = viewer.ground;
  std::size_t visited = sent.boxes.size();
  std::vector<Box> near;
  if (const auto& view = base_.interest.find(viewer.id())->view())
    near = boxes_near(base_, *view, visited);
  std::sort(near.begin(), near.end(), [](Box a, Box b) { return a->by.seq < b->by.seq; });
  const bool is_operator = base_.rights.is_operator(key);
  const Role& role = base_.rights.state().role_of(key);
  ProtectedGround change;
  std::map<Sequence, bool> known;
  for (const Box box : near) {
    const bool is_admitted = is_operator || admits(box->value, key, role);
    known.emplace_hint(known.end(), box->by.seq, is_admitted);
    const auto had = sent.boxes.find(box->by.seq);
    if (had != sent.boxes.end() && had->second == is_admitted) continue;
    change.boxes.push_back({box->by.seq, box->value.box, box->value.priority, is_admitted,
                            box->value.name, owner_text(base_.order.players(), box->value)});
  }
  for (const auto& [seq, was_admitted] : sent.boxes) {
    if (!known.contains(seq)) change.removed.push_back(seq);
  }
  const bool is_empty = change.boxes.empty() && change.removed.empty();
  if (is_empty || base_.sessions.send_or_skip(viewer.session, encode_message(change))) {
    sent.boxes = std::move(known);
    sent.are_boxes_due = false;
  }
  return visited + 1;
}

void GroundRules::start(Viewer& viewer) {
  if (!has_ground(viewer)) return;
  refresh_permissions(viewer);
  send_permissions(viewer);
}

void GroundRules::rights_changed(const std::vector<VoxelBox>& ground) {
  for (Viewer* viewer : base_.open()) {
    if (!has_ground(*viewer)) continue;
    refresh_permissions(*viewer);
    const VoxelBox seen = ground_of(base_, viewer->id());
    const bool is_near = !seen.empty() && std::ranges::any_of(ground, [&](const VoxelBox& box) {
      return overlaps(box, seen);
    });
    if (is_near) viewer->ground.are_boxes_due = true;
  }
}

void GroundRules::send_due() {
  std::vector<Viewer*> due;
  for (Viewer* viewer : base_.open()) {
    if (!has_ground(*viewer)) continue;
    const TimeUs until_us = viewer->ground.restricted_until_us;
    if (until_us != 0 && base_.rights.time() >= until_us) refresh_permissions(*viewer);
    if (viewer->ground.are_permissions_due) send_permissions(*viewer);
    if (viewer->ground.are_boxes_due && !viewer->sees_past()) due.push_back(viewer);
  }
  // Sessions behind the one served last come first, so that every session is served.
  std::ranges::rotate(due, std::ranges::upper_bound(due, sent_last_, {}, &Viewer::id));
  std::size_t compared = 0;
  for (Viewer* viewer : due) {
    if (compared >= kGroundBoxesPerTick) return;
    sent_last_ = viewer->id();
    compared += send_boxes(*viewer);
  }
}

}  // namespace runstone
