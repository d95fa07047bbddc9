#include "client/panels/world_panels.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include "common/core/text.hpp"
#include "common/rights/right.hpp"

namespace runstone {
namespace {

constexpr double kRadiansPerTurn = 2 * std::numbers::pi / 65'536;

}  // namespace

ShownPanels shown_panels(const PanelWindows& windows) {
  const MapWindow& map = windows.map();
  return {windows.tools().is_open(),
          map.is_open(),
          windows.timeline().is_open(),
          windows.rollback().is_open(),
          windows.library().is_open(),
          map.centre_x(),
          map.centre_z()};
}

void WorldPanels::set_materials(const MaterialTable& materials, MeshMaterialsPtr meshed) {
  map_.set_materials(materials);
  rollback_.set_materials(std::move(meshed));
}

bool WorldPanels::step(const ShownPanels& shown, TimeUs now_us) {
  players_.update(session_.others(), now_us);
  poses_ = players_.at(now_us);
  bool has_changed = rollback_.step();
  if (shown.library) {
    library_.list_first();
  } else {
    library_.drop_picture();
  }
  has_changed = library_.step(now_us) || has_changed;
  if (shown.map && session_.replica().opened()) {
    map_.open(session_.replica());
    has_changed = map_.step(session_.replica(), shown.map_x, shown.map_z) || has_changed;
  } else {
    map_.close();
  }
  if (!shown.timeline && !shown.rollback) return has_changed;
  session_.step_timeline(now_us);
  const std::uint64_t serial = session_.timeline_serial();
  return std::exchange(timeline_serial_, serial) != serial || has_changed;
}

bool WorldPanels::is_loading(const ShownPanels& shown) const {
  if (shown.map && (!map_.is_open() || map_.is_drawing())) return true;
  if (shown.library && library_.is_loading()) return true;
  if (!shown.timeline) return false;
  const LogTimeline& log = session_.timeline();
  const bool is_empty = session_.replica().durable() == 0;
  return log.refusal().empty() && !is_empty && (log.band().empty() || log.is_waiting());
}

void WorldPanels::fill(HudState& state, const ShownPanels& shown, const Pose& me) const {
  for (const auto& [author, other] : session_.others())
    state.names.push_back(with_unseen_replaced(other.name));
  if (shown.map) fill_map(state.map, me);
  if (shown.timeline) fill_timeline(state.timeline);
  if (shown.rollback) fill_rollback(state.rollback);
  if (shown.library) library_.fill(state.library);
}

void WorldPanels::fill_map(MapState& state, const Pose& me) const {
  if (!session_.welcome()) return;
  state.map = &map_;
  const auto turned = [](std::uint16_t yaw) { return yaw * kRadiansPerTurn; };
  state.me = {"", me.at.x, me.at.z, turned(me.yaw)};
  for (const auto& [author, pose] : poses_) {
    const auto other = session_.others().find(author);
    if (other != session_.others().end())
      state.others.push_back(
          {with_unseen_replaced(other->second.name), pose.at.x, pose.at.z, turned(pose.yaw)});
  }
  state.spawn_x = session_.welcome()->spawn.x;
  state.spawn_z = session_.welcome()->spawn.z;
}

void WorldPanels::fill_timeline(TimelineState& state) const {
  const LogTimeline& log = session_.timeline();
  state.band = log.band();
  state.recent = log.recent();
  state.refusal = log.refusal();
  for (const auto* marks : {&state.band, &state.recent}) {
    for (const LogMark& mark : *marks)
      state.authors.try_emplace(mark.author, with_unseen_replaced(log.name_of(mark.author)));
  }
}

void WorldPanels::fill_rollback(RollbackState& state) const {
  const auto& permissions = session_.replica().ground().permissions();
  // A server without the feature checks the right when it gets the command.
  state.is_allowed = !permissions || RightSet::of_bits(permissions->rights).has(Right::roll_back);
  state.has_selection = tools_.selected_box().has_value();
  std::map<AuthorId, std::string> authors;
  for (const auto& [author, other] : session_.others())
    authors[author] = with_unseen_replaced(other.name);
  const LogTimeline& log = session_.timeline();
  for (const auto* marks : {&log.band(), &log.recent()}) {
    for (const LogMark& mark : *marks) {
      if (mark.author != 0)
        authors.try_emplace(mark.author, with_unseen_replaced(log.name_of(mark.author)));
    }
  }
  state.authors.assign(authors.begin(), authors.end());
  std::sort(state.authors.begin(), state.authors.end(),
            [](const auto& a, const auto& b) { return a.second < b.second; });
  rollback_.fill(state);
}

}  // namespace runstone
