#include "client/app/client_hud.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "client/play/time_travel.hpp"
#include "client/render/projection.hpp"
#include "client/replica/ray_pick.hpp"
#include "common/core/text.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

static_assert(kStageCount == kLatencyStageCount);

constexpr double kPlateHeight = 0.45;      // voxels from the eye of a player to its name
constexpr double kPlateDistanceMax = 160;  // voxels
constexpr double kPlateFadeFrom = 40;      // voxels
constexpr std::size_t kPlatesMax = 64;     // the nearest ones
constexpr double kPlateBehindWall = 0.35;  // the share of a plate that is seen there
constexpr TimeUs kRateUs = 500'000;        // rates of traffic are measured over this time

/// Returns the mode of inspection that an action shows or hides, or nullopt.
std::optional<InspectionMode> mode_of(Action action) {
  switch (action) {
    case Action::inspect_wireframe:
      return InspectionMode::wireframe;
    case Action::inspect_runs:
      return InspectionMode::runs;
    case Action::inspect_orders:
      return InspectionMode::orders;
    case Action::inspect_layers:
      return InspectionMode::layers;
    default:
      return std::nullopt;
  }
}

}  // namespace

ClientHud::ClientHud(Play& play, std::string name, double scale)
    : play_(play), name_(std::move(name)), hud_(play.input().keys(), scale) {}

bool ClientHud::act(Action action) {
  if (action == Action::interface) {
    is_shown_ = !is_shown_;
    return true;
  }
  if (const auto mode = mode_of(action)) {
    InspectionModes modes = play_.pipeline().inspection().modes();
    modes.set(*mode, !modes[*mode]);
    play_.pipeline().inspect(modes);
    return true;
  }
  return hud_.act(action);
}

std::shared_ptr<const OverlayFrame> ClientHud::make_frame(const HudScene& scene, TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - std::exchange(made_us_, now_us)) / 1e6;
  HudState shown = state(scene);
  if (hud_.shows_statistics()) shown.statistics = statistics(scene, now_us);
  auto frame = hud_.make_frame(shown, scene.size, seconds);
  for (const UiAction& action : hud_.take_actions()) {
    play_.carry_out(action, now_us);
    if (const auto* file = std::get_if<ClipboardOfFile>(&action)) files_.push_back(*file);
    stops_file_ = stops_file_ || std::holds_alternative<FileStop>(action);
  }
  if (!is_shown_) return nullptr;
  return frame;
}

HudState ClientHud::state(const HudScene& scene) const {
  HudState out;
  play_.fill(out, shown_panels());
  out.is_captured = out.is_captured || !scene.has_window;
  out.is_connected = scene.is_connected;
  const WorldPos eye = play_.player().eye();
  out.place = fmt::format("{:.0f} {:.0f} {:.0f}  {}", std::floor(eye.x), std::floor(eye.y),
                          std::floor(eye.z), play_.player().is_walking() ? "walking" : "flying");
  out.state = scene.state;
  out.has_files = true;
  out.file = scene.file;
  out.tool = play_.tool().text();
  out.shows_players = scene.shows_players;
  if (out.shows_players) add_players(out);
  add_plates(scene, out);
  add_timeline(out.timeline);
  out.inspection = play_.pipeline().inspection().modes();
  return out;
}

ShownPanels ClientHud::shown_panels() const { return runstone::shown_panels(hud_.panels()); }

void ClientHud::add_players(HudState& state) const {
  const auto& permissions = play_.session().replica().ground().permissions();
  state.players.push_back({name_, "you", permissions ? permissions->role : "", {}});
  const WorldPos eye = play_.player().eye();
  for (const auto& [author, other] : play_.session().others()) {
    ListedPlayer listed{with_unseen_replaced(other.name),
                        key_fingerprint(other.key),
                        with_unseen_replaced(other.role),
                        {}};
    if (other.pose) {
      const WorldPos& at = other.pose->at;
      listed.distance =
          fmt::format("{:.0f} voxels", std::hypot(at.x - eye.x, at.y - eye.y, at.z - eye.z));
    }
    state.players.push_back(std::move(listed));
  }
}

void ClientHud::add_plates(const HudScene& scene, HudState& state) const {
  struct Seen {
    NamePlate plate;
    WorldPos head;
  };
  std::vector<Seen> seen;
  for (const auto& [author, pose] : play_.panels().poses()) {
    const auto other = play_.session().others().find(author);
    if (other == play_.session().others().end()) continue;
    const auto at =
        project(scene.camera, scene.size, pose.at.x, pose.at.y + kPlateHeight, pose.at.z);
    if (at && at->distance <= kPlateDistanceMax)
      seen.push_back({{other->second.name, at->x, at->y, at->distance}, pose.at});
  }
  std::ranges::sort(seen, {}, [](const Seen& each) { return each.plate.distance; });
  if (seen.size() > kPlatesMax) seen.resize(kPlatesMax);
  // The nearest one is drawn last, over the others.
  for (auto each = seen.rbegin(); each != seen.rend(); ++each) {
    each->plate.name = with_unseen_replaced(each->plate.name);
    each->plate.alpha = plate_alpha(each->head, each->plate.distance);
    state.plates.push_back(std::move(each->plate));
  }
}

double ClientHud::plate_alpha(const WorldPos& head, double distance) const {
  const double far = (kPlateDistanceMax - distance) / (kPlateDistanceMax - kPlateFadeFrom);
  const double alpha = std::clamp(far, 0.0, 1.0);
  const WorldPos eye = play_.player().eye();
  const double dx = head.x - eye.x, dy = head.y - eye.y, dz = head.z - eye.z;
  const double length = std::max(1e-6, std::sqrt(dx * dx + dy * dy + dz * dz));
  const bool is_hidden = pick(play_.session().replica(), play_.tool().shapes(), eye,
                              {dx / length, dy / length, dz / length}, length)
                             .has_value();
  return is_hidden ? alpha * kPlateBehindWall : alpha;
}

void ClientHud::add_timeline(TimelineState& state) const {
  const ShownSequence now = shown_sequence(play_.session());
  state.newest = now.newest;
  state.shown = now.shown;
  state.is_loading = play_.session().loading_history();
  if (const auto& past = play_.session().replica().past()) {
    state.is_past = true;
    const std::time_t seconds = past->utc_us / 1'000'000;
    if (past->utc_us != 0)
      state.moment = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(seconds));
  }
}

StatisticsState ClientHud::statistics(const HudScene& scene, TimeUs now_us) {
  StatisticsState out;
  out.renderer = play_.pipeline().renderer_name();
  const std::deque<FrameDone>& frames = play_.pipeline().recent_frames();
  for (const FrameDone& frame : frames)
    out.frame_ms.push_back(static_cast<float>(frame.presented_us - frame.started_us) / 1e3F);
  if (frames.size() > 1) {
    const TimeUs span_us = frames.back().presented_us - frames.front().presented_us;
    out.frames_per_second = static_cast<double>(frames.size() - 1) * 1e6 /
                            static_cast<double>(std::max<TimeUs>(1, span_us));
  }
  if (!frames.empty()) {
    const RenderStats& stats = frames.back().stats;
    out.chunks_drawn = stats.chunks_drawn;
    out.chunks_culled = stats.chunks_culled;
    out.quads_drawn = stats.quads_drawn;
    out.tile_parts_drawn = stats.tile_parts_drawn;
  }
  const MemoryUse memory = play_.limits().use();
  out.chunk_bytes = memory.chunks;
  out.edit_bytes = memory.edits;
  out.mesh_bytes = memory.meshes;
  out.gpu_bytes = memory.gpu;
  out.texture_bytes = memory.textures;
  out.bytes_max = play_.limits().budget().bytes_max();
  out.tiles = play_.session().replica().far_tiles().count();
  out.tile_levels = play_.session().view().levels;
  out.far_bytes = play_.pipeline().far_bytes();
  out.far_bytes_max = play_.limits().far().bytes_max();
  out.reach = play_.scene().reach();
  out.mesh_jobs = play_.pipeline().mesh_jobs();
  const auto median_us = [](const Histogram& ns) -> std::optional<double> {
    const auto median = ns.percentile(0.5);
    if (!median) return std::nullopt;
    return static_cast<double>(*median) / 1e3;
  };
  out.mesh_whole_us = median_us(play_.pipeline().whole_mesh_ns());
  out.mesh_layers_us = median_us(play_.pipeline().layers_mesh_ns());
  add_traffic(scene.net, now_us, out);
  if (play_.session().clock().known())
    out.ping_ms = static_cast<double>(play_.session().clock().round_trip_us()) / 1e3;
  out.pending_edits = play_.session().replica().local_edits().unanswered().size();
  out.open_edits = play_.pipeline().recorder().open_edits();
  out.digests_checked = play_.session().replica().counters().digests_checked;
  out.digests_differed = play_.session().replica().counters().drifted;
  for (std::size_t s = 0; s < kStageCount; ++s)
    out.stages[s] = to_string(static_cast<LatencyStage>(s));
  for (const RecentEdit& edit : play_.pipeline().recorder().recent()) {
    EditWay way{edit.path == EditPath::local_predicted, {}};
    for (std::size_t s = 0; s < kStageCount; ++s)
      way.end_ms[s] =
          edit.reached[s] ? static_cast<double>(edit.at[s] - edit.submitted_us) / 1e3 : -1;
    out.edits.push_back(way);
  }
  return out;
}

void ClientHud::add_traffic(const NetCounts& net, TimeUs now_us, StatisticsState& out) {
  const auto by_class = [](const NetCounts& counts) {
    return std::array<std::uint64_t, 4>{counts.chunk_bytes, counts.edit_bytes, counts.control_bytes,
                                        counts.bytes_sent};
  };
  const auto now = by_class(net), before = by_class(net_before_);
  if (now_us - net_us_ >= kRateUs) {
    const double seconds = static_cast<double>(now_us - net_us_) / 1e6;
    for (std::size_t i = 0; i < now.size(); ++i)
      rates_[i] = net_us_ == 0 ? 0 : static_cast<double>(now[i] - before[i]) / seconds;
    net_before_ = net;
    net_us_ = now_us;
  }
  constexpr std::array<const char*, 4> kNames = {"chunks", "edits", "control", "sent"};
  for (std::size_t i = 0; i < now.size(); ++i) out.traffic[i] = {kNames[i], now[i], rates_[i]};
}

}  // namespace runstone
