#include "bench/client/client_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bench/client/gl/client_rig.hpp"
#include "bench/client/gl/effects_case.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "client/platform/gl_context.hpp"
#include "client/render/renderer.hpp"
#include "common/core/assert.hpp"

namespace runstone::bench {
namespace {

/// Frames after a burst in which the rest of its light and shadows is drawn.
constexpr unsigned kLightFrames = 60;

double ms_of(TimeUs us) { return static_cast<double>(us) / 1e3; }

const VoxelWorld& hills(const std::vector<VoxelWorld>& worlds) {
  const auto found = std::find_if(worlds.begin(), worlds.end(),
                                  [](const VoxelWorld& world) { return world.name == "hills"; });
  RUNSTONE_ASSERT(found != worlds.end());
  return *found;
}

BurstRow measure_bursts(const VoxelWorld& world, const ClientBenchOptions& options,
                        const char* name, const UploadBudget& budget) {
  RigOptions rig_options;
  rig_options.width = options.width;
  rig_options.height = options.height;
  rig_options.budget = budget;
  ClientRig rig(world, rig_options);
  BurstRow out;
  out.budget = name;
  out.edits = options.edits;
  out.bursts = options.bursts;
  out.frames_min = std::numeric_limits<std::size_t>::max();
  for (unsigned i = 0; i < kLightFrames; ++i) rig.frame();
  std::vector<double> still_ms, still_slowest_ms, slowest_ms;
  for (unsigned burst = 0; burst < options.bursts; ++burst) {
    const auto whole_ms = [](const FrameCost& cost) {
      return ms_of(cost.added_us() + cost.draw_us);
    };
    // As many frames without a burst have a slowest one, too: the machine is not alone.
    double slowest = 0;
    rig.finish();
    for (unsigned i = 0; i < kLightFrames; ++i) {
      still_ms.push_back(whole_ms(rig.frame()));
      slowest = std::max(slowest, still_ms.back());
    }
    still_slowest_ms.push_back(std::exchange(slowest, 0));
    rig.receive_edits(options.edits);
    std::size_t frames = 0;
    do {
      const FrameCost cost = rig.frame();
      slowest = std::max(slowest, whole_ms(cost));
      ++frames;
      out.worst_added_ms = std::max(out.worst_added_ms, ms_of(cost.added_us()));
      out.worst_mesh_ms = std::max(out.worst_mesh_ms, ms_of(cost.mesh_us));
      out.worst_upload_ms = std::max(out.worst_upload_ms, ms_of(cost.upload_us));
      out.total_ms += ms_of(cost.added_us()) / options.bursts;
      out.carried_max = std::max(out.carried_max, cost.carried);
    } while (rig.has_open_edits());
    for (unsigned i = 0; i < kLightFrames; ++i) slowest = std::max(slowest, whole_ms(rig.frame()));
    slowest_ms.push_back(slowest);
    out.frames_min = std::min(out.frames_min, frames);
    out.frames_max = std::max(out.frames_max, frames);
  }
  out.still_ms = median(still_ms);
  out.still_slowest_ms = median(still_slowest_ms);
  out.slowest_ms = median(slowest_ms);
  return out;
}

OwnEditRow measure_own_edits(const VoxelWorld& world, const ClientBenchOptions& options) {
  RigOptions rig_options;
  rig_options.width = options.width;
  rig_options.height = options.height;
  rig_options.quality = Quality::low;
  rig_options.watches_pixels = true;
  ClientRig rig(world, rig_options);
  OwnEditRow out;
  out.edits = options.own_edits;
  for (unsigned i = 0; i < options.own_edits; ++i) {
    rig.finish();
    // A frame is in progress when the edit is made: frame() orders the next one in its last turn.
    const std::uint64_t before = rig.pixels();
    rig.edit();
    std::size_t frames = 0;
    constexpr std::size_t kFramesMax = 100;
    do {
      rig.frame();
      ++frames;
    } while (rig.pixels() == before && frames < kFramesMax);
    out.frames_max = std::max(out.frames_max, frames);
    out.frames_mean += static_cast<double>(frames) / options.own_edits;
  }
  return out;
}

}  // namespace

Result<ClientBenchResult, std::string> run_client_bench(const ClientBenchOptions& options,
                                                        std::ostream& progress) {
  ClientBenchResult out;
  out.machine = this_machine();
  out.width = options.width;
  out.height = options.height;
  const std::vector<VoxelWorld> worlds = seeded_worlds();
  const VoxelWorld& world = hills(worlds);
  const auto say = [&progress](const char* what) {
    fmt::print(progress, "{}\n", what);
    progress.flush();
  };
  try {
    out.bursts.push_back(measure_bursts(world, options, "at most 4 ms", {}));
    say("bursts, with a budget");
    constexpr UploadBudget kNone{std::numeric_limits<TimeUs>::max() / 2,
                                 std::numeric_limits<std::size_t>::max()};
    out.bursts.push_back(measure_bursts(world, options, "all", kNone));
    say("bursts, without");
    out.own_edit = measure_own_edits(world, options);
    say("own edits");
    auto effects = measure_effects(options, progress);
    if (!effects) return failure(effects.error());
    out.effects = std::move(effects->rows);
    out.gl_renderer = effects->gl_renderer;
    out.gl_context = effects->gl_context;
    return out;
  } catch (const std::runtime_error& error) {  // the platform and the renderer throw
    return failure(error.what());
  }
}

}  // namespace runstone::bench
