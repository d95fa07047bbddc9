#include "bench/client/gl/effects_case.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <array>
#include <memory>
#include <numbers>
#include <numeric>

#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/view/view_pane.hpp"
#include "bench/view/view_world.hpp"
#include "bench/worlds/seeded_worlds.hpp"
#include "client/platform/gl_context.hpp"
#include "client/render/gl_handle.hpp"
#include "client/render/renderer.hpp"
#include "common/core/hash.hpp"

namespace runstone::bench {
namespace {

constexpr std::uint64_t kOrderSeed = 16;
constexpr unsigned kEdge = 32;
constexpr std::array<Quality, 3> kQualities = {Quality::low, Quality::medium, Quality::high};
constexpr std::array<const char*, 3> kQualityNames = {"low", "medium", "high"};

/// One way to draw a world, with a renderer of its own: its shadow maps last from frame to frame, as
/// those of a client.
struct Way {
  EffectsRow row;
  std::unique_ptr<Renderer> renderer;
  Quality quality{};
  std::vector<double> ms;
};

constexpr double kVoxelsAFrame = 0.25;  // a player who flies: 10 voxels a second at 40 frames

/// Returns the camera of a player who flies over the middle of the block and turns around once.
Camera player_camera(const FramesWorld& world, unsigned frame, unsigned frames) {
  const double edge = world.edge;
  Camera out;
  out.x = world.size[0] * edge / 2 + kVoxelsAFrame * frame;
  out.y = world.size[1] * edge * 0.75;
  out.z = world.size[2] * edge / 2;
  out.yaw = 2 * std::numbers::pi * frame / frames;
  out.pitch = -0.3;
  out.far = world.size[0] * edge;
  return out;
}

double draw_ms(const Way& way, const Camera& camera, const ClientBenchOptions& options,
               RenderStats* stats = nullptr) {
  FrameContents contents;
  contents.look.quality = way.quality;
  contents.look.exact = false;  // as in a window
  const std::uint64_t start = now_ns();
  const RenderStats drawn = way.renderer->draw(camera, options.width, options.height, contents);
  way.renderer->finish();
  if (stats != nullptr) *stats = drawn;
  return static_cast<double>(now_ns() - start) * 1e-6;
}

Result<FramesWorld, std::string> world_of(const std::string& name, const std::string& luanti) {
  for (const VoxelWorld& world : seeded_worlds()) {
    if (world.name == name) return block_of(world, {0, -32, 0}, {10, 2, 10}, kEdge);
  }
  return view_world(name, luanti);
}

void measure(const FramesWorld& world, const ClientBenchOptions& options, GlContextLoader loader,
             EffectsResult& to) {
  const std::vector<ViewPane> panes = view_panes(world, 1);
  const MaterialTable materials = materials_of(world);
  std::vector<Way> ways;
  for (const ViewPane* pane : {&panes.front(), &panes.back()}) {  // culled faces and RDM
    for (std::size_t q = 0; q < kQualities.size(); ++q) {
      Way way;
      way.row.world = world.name;
      way.row.mesher = ways.size() < kQualities.size() ? "culled" : "rdm";
      way.row.quality = kQualityNames[q];
      way.row.frames = options.frames;
      way.quality = kQualities[q];
      way.renderer = std::make_unique<Renderer>(loader);
      way.renderer->set_materials(materials);
      for (std::size_t i = 0; i < pane->chunks.size(); ++i) {
        way.renderer->upload({0, pane->chunks[i].at}, static_cast<std::int32_t>(world.edge),
                             pane->chunks[i].mesh, &world.chunks[i].volume.scene.chunk);
      }
      // The first frames compile shaders and draw all shadows.
      RenderStats stats;
      for (int i = 0; i < 2; ++i)
        draw_ms(way, player_camera(world, 0, options.frames), options, &stats);
      way.row.quads_drawn = stats.quads_drawn;
      ways.push_back(std::move(way));
    }
  }
  std::vector<std::size_t> order(ways.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  SplitMix64 rng(kOrderSeed);
  for (unsigned frame = 0; frame < options.frames; ++frame) {
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
    for (const std::size_t i : order) {
      ways[i].ms.push_back(draw_ms(ways[i], player_camera(world, frame, options.frames), options));
    }
  }
  for (Way& way : ways) {
    way.row.p50_ms = median(way.ms);
    way.row.p90_ms = quantile(way.ms, 0.9);
    to.rows.push_back(std::move(way.row));
  }
}

}  // namespace

Result<EffectsResult, std::string> measure_effects(const ClientBenchOptions& options,
                                                   std::ostream& progress) {
  const auto context = make_headless_context();
  EffectsResult out;
  out.gl_context = context->name();
  for (const char* name : {"hills", "luanti"}) {
    const auto world = world_of(name, options.luanti);
    if (!world) return failure(world.error());
    measure(*world, options, context->loader(), out);
    fmt::print(progress, "effects, {}\n", name);
    progress.flush();
  }
  const GLubyte* const text = glGetString(GL_RENDERER);
  out.gl_renderer = text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
  return out;
}

}  // namespace runstone::bench
