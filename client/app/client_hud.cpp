#include "client/app/client_hud.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "client/panels/panel_actions.hpp"
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

ClientHud::ClientHud(ClientSession& session, Player& player, MeshPipeline& pipeline,
                     TerminalChat& chat, WorldPanels& panels, EditTool& tool, std::string name,
                     const KeyMap& keys, double scale)
    : session_(session),
      player_(player),
      pipeline_(pipeline),
      chat_(chat),
      panels_(panels),
      tool_(tool),
      name_(std::move(name)),
      hud_(keys, scale),
      hotbar_(player) {}

bool ClientHud::act(Action action) {
  if (hotbar_.act(action)) return true;
  if (action == Action::interface) {
    is_shown_ = !is_shown_;
    return true;
  }
  if (const auto mode = mode_of(action)) {
    InspectionModes modes = pipeline_.inspection().modes();
    modes.set(*mode, !modes[*mode]);
    pipeline_.inspect(modes);
    return true;
  }
  return hud_.act(action);
}

bool ClientHud::take_chat() {
  std::vector<ShownLine> lines = chat_.take_shown();
  const bool has_lines = !lines.empty();
  for (ShownLine& line : lines) hud_.hear(std::move(line));
  return has_lines;
}

std::shared_ptr<const OverlayFrame> ClientHud::make_frame(const HudScene& scene, TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - std::exchange(made_us_, now_us)) / 1e6;
  HudState shown = state(scene);
  if (hud_.shows_statistics()) shown.statistics = statistics(scene, now_us);
  auto frame = hud_.make_frame(shown, scene.size, seconds);
  for (const UiAction& action : hud_.take_actions()) carry_out(action, now_us);
  if (!is_shown_) return nullptr;
  return frame;
}

HudState ClientHud::state(const HudScene& scene) const {
  HudState out;
  out.materials = &pipeline_.materials();
  out.slots = hotbar_.slots().slots();
  out.slot = hotbar_.slots().slot();
  out.is_captured = scene.is_captured;
  out.is_connected = scene.is_connected;
  const WorldPos eye = player_.eye();
  out.place = fmt::format("{:.0f} {:.0f} {:.0f}  {}", std::floor(eye.x), std::floor(eye.y),
                          std::floor(eye.z), player_.is_walking() ? "walking" : "flying");
  if (scene.sight) {
    out.aimed_at = scene.sight->material;
    out.sight = scene.sight->voxel;
  }
  out.tools = &tool_.box();
  out.has_preview = tool_.has_preview();
  out.state = scene.state;
  out.tool = scene.tool;
  out.shows_players = scene.shows_players;
  if (out.shows_players) add_players(out);
  add_plates(scene, out);
  out.timeline = timeline();
  out.inspection = pipeline_.inspection().modes();
  panels_.fill(out, shown_panels());
  return out;
}

ShownPanels ClientHud::shown_panels() const { return runstone::shown_panels(hud_.panels()); }

void ClientHud::add_players(HudState& state) const {
  const auto& permissions = session_.replica().ground().permissions();
  state.players.push_back({name_, "you", permissions ? permissions->role : "", {}});
  const WorldPos eye = player_.eye();
  for (const auto& [author, other] : session_.others()) {
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
  for (const auto& [author, pose] : panels_.poses()) {
    const auto other = session_.others().find(author);
    if (other == session_.others().end()) continue;
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
  const WorldPos eye = player_.eye();
  const double dx = head.x - eye.x, dy = head.y - eye.y, dz = head.z - eye.z;
  const double length = std::max(1e-6, std::sqrt(dx * dx + dy * dy + dz * dz));
  const bool is_hidden =
      pick(session_.replica(), eye, {dx / length, dy / length, dz / length}, length).has_value();
  return is_hidden ? alpha * kPlateBehindWall : alpha;
}

TimelineState ClientHud::timeline() const {
  TimelineState out;
  const Replica& replica = session_.replica();
  const ShownSequence now = shown_sequence(session_);
  out.newest = now.newest;
  out.shown = now.shown;
  out.is_loading = session_.loading_history();
  if (const auto& past = replica.past()) {
    out.is_past = true;
    const std::time_t seconds = past->utc_us / 1'000'000;
    if (past->utc_us != 0)
      out.moment = fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(seconds));
  }
  return out;
}

StatisticsState ClientHud::statistics(const HudScene& scene, TimeUs now_us) {
  StatisticsState out;
  out.renderer = pipeline_.renderer_name();
  const std::deque<FrameDone>& frames = pipeline_.recent_frames();
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
  out.chunk_bytes = scene.memory.chunks;
  out.edit_bytes = scene.memory.edits;
  out.mesh_bytes = scene.memory.meshes;
  out.gpu_bytes = scene.memory.gpu;
  out.bytes_max = scene.memory_max;
  out.tiles = session_.replica().far_tiles().count();
  out.tile_levels = session_.view().levels;
  out.far_bytes = pipeline_.far_bytes();
  out.far_bytes_max = scene.far_bytes_max;
  out.reach = scene.reach;
  out.mesh_jobs = pipeline_.mesh_jobs();
  const auto median_us = [](const Histogram& ns) -> std::optional<double> {
    const auto median = ns.percentile(0.5);
    if (!median) return std::nullopt;
    return static_cast<double>(*median) / 1e3;
  };
  out.mesh_whole_us = median_us(pipeline_.whole_mesh_ns());
  out.mesh_layers_us = median_us(pipeline_.layers_mesh_ns());
  add_traffic(scene.net, now_us, out);
  if (session_.clock().known())
    out.ping_ms = static_cast<double>(session_.clock().round_trip_us()) / 1e3;
  out.pending_edits = session_.replica().local_edits().unanswered().size();
  out.open_edits = pipeline_.recorder().open_edits();
  out.digests_checked = session_.replica().counters().digests_checked;
  out.digests_differed = session_.replica().counters().drifted;
  for (std::size_t s = 0; s < kStageCount; ++s)
    out.stages[s] = to_string(static_cast<LatencyStage>(s));
  for (const RecentEdit& edit : pipeline_.recorder().recent()) {
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

void ClientHud::carry_out(const UiAction& action, TimeUs now_us) {
  if (const auto* line = std::get_if<SendLine>(&action)) chat_.send(line->text);
  if (const auto* held = std::get_if<HoldMaterial>(&action)) hotbar_.hold(held->material);
  if (const auto* chosen = std::get_if<SetInspection>(&action)) pipeline_.inspect(chosen->modes);
  if (const auto done = carry_out_panel(action, session_, panels_, tool_, now_us); !done)
    notify(done.error(), NoticeKind::warning);
}

}  // namespace runstone
