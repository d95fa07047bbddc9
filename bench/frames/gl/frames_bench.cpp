#include "bench/frames/frames_bench.hpp"

#include <fmt/ostream.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "bench/frames/frames_world.hpp"
#include "bench/frames/gl/orbit.hpp"
#include "bench/frames/gl/plain_renderer.hpp"
#include "bench/frames/gl/product_planes.hpp"
#include "bench/harness/clocks.hpp"
#include "bench/harness/statistics.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "client/platform/gl_context.hpp"
#include "client/render/renderer.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/reference/t_junctions.hpp"
#include "tests/reference/thin_triangles.hpp"

namespace runstone::bench {
namespace {

constexpr const char* kReference = "culled";  // no T-junctions: every face has its own four corners
constexpr std::uint64_t kOrderSeed = 37;      // of the order in which meshers draw
/// The time that a mesher may take, in ms for each wanted frame. A slower mesher draws fewer
/// frames.
constexpr double kFrameMsMean = 50;
constexpr unsigned kFramesMin = 3;

/// A mesher and a path, which draw a world.
struct Painter {
  FramesRow row;
  std::function<void(const Camera&)> draw;  // one frame, to its end
  PlainScene* scene = nullptr;              // of a plain painter
  bool wanted = true;                       // false: only there as the reference
  unsigned stride = 1;                      // draws every stride-th frame
  std::vector<double> frame_ms;
};

std::string gl_text(GLenum what) {
  const GLubyte* const text = glGetString(what);
  return text == nullptr ? "unknown" : reinterpret_cast<const char*>(text);
}

/// The reason why a world is not drawn; empty if it is drawn.
using Refusal = std::string;

/// Uploads the chunks of a world as a mesher makes them, and counts what can be counted before they
/// are drawn.
Refusal mesh_world(const FramesWorld& world, std::size_t vertices_max, PlainScene& scene,
                   FramesRow& row) {
  reference::ThinTriangles thin;
  std::size_t junctions = 0;
  reference::Surface surface;
  IndexedMesh mesh;
  const auto side = static_cast<std::int32_t>(world.edge);
  for (const FramesChunk& chunk : world.chunks) {
    const auto mesher_case = make_mesher_case(row.mesher, chunk.volume, *world.visibility);
    if (!mesher_case) return "it cannot take the chunks";
    PhaseTimes phases{};
    mesher_case->mesh(phases);
    mesher_case->surface(surface);
    if (scene.vertices() + surface.vertex_count() > vertices_max) {
      return fmt::format("more than {} vertices", vertices_max);
    }
    const VoxelPos at = origin_of(chunk.at, side);
    const glm::vec3 origin{at.x, at.y, at.z};
    if (row.path == "quads") {
      scene.add(origin, world.edge, surface.quads);
    } else {
      index_surface(surface, mesh);
      scene.add(origin, world.edge, mesh);
    }
    const reference::ThinTriangles of_chunk = reference::count_thin_triangles(surface);
    thin.above_16 += of_chunk.above_16;
    thin.above_100 += of_chunk.above_100;
    junctions += reference::count_t_junctions(surface).places;
  }
  if (scene.triangles() == 0) return {};
  row.t_junctions = junctions;
  row.thin_16 = static_cast<double>(thin.above_16) / static_cast<double>(scene.triangles());
  row.thin_100 = static_cast<double>(thin.above_100) / static_cast<double>(scene.triangles());
  return {};
}

/// Uploads the product's mesh to the product's renderer.
void mesh_product(const FramesWorld& world, Renderer& renderer, FramesRow& row) {
  RdmScratch scratch;
  ChunkMesh mesh;
  std::size_t quads = 0;
  for (const FramesChunk& chunk : world.chunks) {
    mesh_rdm(chunk.volume.scene.chunk, chunk.volume.scene.pointers(), {}, *world.visibility,
             scratch, mesh);
    renderer.upload({0, chunk.at}, static_cast<std::int32_t>(world.edge), mesh);
    quads += mesh.quad_count();
  }
  row.vertices = 4 * quads;
  row.triangles = 2 * quads;
}

class FramesBench {
 public:
  explicit FramesBench(const FramesOptions& options)
      : options_(options),
        context_(make_headless_context()),
        plain_(context_->loader(), options.width, options.height) {
    result_.machine = this_machine();
    result_.gl_renderer = gl_text(GL_RENDERER);
    result_.gl_version = gl_text(GL_VERSION);
    result_.gl_context = context_->name();
    result_.width = options.width;
    result_.height = options.height;
    result_.frames = options.frames;
    result_.pictures = options.pictures;
  }

  void measure(const FramesWorld& world) {
    size_ = world.size;
    for (int& side : size_) side *= static_cast<int>(world.edge);
    scenes_.clear();
    renderer_.reset();
    planes_.reset();
    std::vector<Painter> painters = painters_of(world);
    time(painters);
    compare_pictures(painters);
    for (Painter& painter : painters) {
      if (!painter.wanted) continue;
      FramesRow& row = painter.row;
      row.frames = static_cast<unsigned>(painter.frame_ms.size());
      row.p50_ms = median(painter.frame_ms);
      row.p90_ms = quantile(painter.frame_ms, 0.9);
      row.p99_ms = quantile(painter.frame_ms, 0.99);
      result_.rows.push_back(std::move(row));
    }
  }

  FramesResult take_result() { return std::move(result_); }

 private:
  Camera camera(unsigned frame) const { return orbit_camera(size_, frame, options_.frames); }

  /// Returns a painter that draws `scene`, whose counts are in `row`.
  Painter plain_painter(FramesRow row, PlainScene& scene) {
    row.vertices = scene.vertices();
    row.triangles = scene.triangles();
    row.upload_bytes = scene.byte_size();
    Painter out;
    out.row = std::move(row);
    out.scene = &scene;
    out.draw = [this, &scene](const Camera& at) {
      plain_.draw(scene, at);
      glFinish();
    };
    return out;
  }

  PlainScene& new_scene() { return *scenes_.emplace_back(std::make_unique<PlainScene>()); }

  std::vector<Painter> painters_of(const FramesWorld& world) {
    std::vector<std::string> meshers =
        options_.meshers.empty() ? frames_meshers_by_default() : options_.meshers;
    const bool wants_reference =
        std::find(meshers.begin(), meshers.end(), kReference) != meshers.end();
    if (!wants_reference) meshers.emplace_back(kReference);
    std::vector<Painter> out;
    FramesRow row;
    row.world = world.name;
    row.path = "plain";
    row.mesher = "none";  // an empty frame
    out.push_back(plain_painter(row, new_scene()));
    for (const std::string& mesher : meshers) {
      if (mesher == "product") {
        out.push_back(product_painter(world));
        continue;
      }
      FramesRow of_mesher = row;
      of_mesher.mesher = mesher == "quads" ? "rdm" : mesher;
      if (mesher == "quads") of_mesher.path = mesher;
      PlainScene& scene = new_scene();
      // The reference is drawn whatever its size.
      const std::size_t vertices_max =
          mesher == kReference ? std::numeric_limits<std::size_t>::max() : options_.vertices_max;
      const Refusal refusal = mesh_world(world, vertices_max, scene, of_mesher);
      if (!refusal.empty()) {
        result_.skipped.push_back(fmt::format("{} {}: {}", world.name, mesher, refusal));
        scenes_.pop_back();
        continue;
      }
      out.push_back(plain_painter(std::move(of_mesher), scene));
      out.back().wanted = mesher != kReference || wants_reference;
    }
    return out;
  }

  Painter product_painter(const FramesWorld& world) {
    renderer_ = std::make_unique<Renderer>(context_->loader());
    planes_ = std::make_unique<ProductPlanes>(context_->loader(), world);
    Painter out;
    out.row.world = world.name;
    out.row.mesher = "rdm";
    out.row.path = "product";
    mesh_product(world, *renderer_, out.row);
    out.draw = [this](const Camera& at) {
      // As in a flight: the light of lamps and rooms follows the eye some frames later.
      FrameContents contents;
      contents.look.exact = false;
      renderer_->draw(at, options_.width, options_.height, contents);
      renderer_->finish();
    };
    out.row.upload_bytes = renderer_->draw(camera(0), options_.width, options_.height).quad_bytes;
    return out;
  }

  static double draw_ms(const Painter& painter, const Camera& at) {
    const std::uint64_t start = now_ns();
    painter.draw(at);
    return static_cast<double>(now_ns() - start) * 1e-6;
  }

  /// Times the frames of all painters, shuffled within each position of the camera.
  void time(std::vector<Painter>& painters) {
    for (Painter& painter : painters) {
      double warm_ms = draw_ms(painter, camera(0));  // compiles shaders and touches memory
      if (warm_ms > kFrameMsMean) warm_ms = std::min(warm_ms, draw_ms(painter, camera(0)));
      const double wanted = options_.frames * std::min(1.0, kFrameMsMean / warm_ms);
      const unsigned frames = std::max(kFramesMin, static_cast<unsigned>(wanted));
      painter.stride = std::max(1u, options_.frames / frames);
    }
    SplitMix64 rng(kOrderSeed);
    std::vector<std::size_t> order(painters.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (unsigned frame = 0; frame < options_.frames; ++frame) {
      for (std::size_t i = order.size(); i > 1; --i) {
        std::swap(order[i - 1], order[rng.below(static_cast<std::uint32_t>(i))]);
      }
      for (const std::size_t i : order) {
        Painter& painter = painters[i];
        if (frame % painter.stride == 0)
          painter.frame_ms.push_back(draw_ms(painter, camera(frame)));
      }
    }
  }

  /// Compares the pictures and counts their fragments.
  void compare_pictures(std::vector<Painter>& painters) {
    const auto reference =
        std::find_if(painters.begin(), painters.end(), [](const Painter& painter) {
          return painter.scene != nullptr && painter.row.mesher == kReference;
        });
    for (unsigned picture = 0; picture < options_.pictures; ++picture) {
      const Camera at = camera(picture * options_.frames / options_.pictures);
      plain_.draw(*reference->scene, at);
      const DrawnPicture expected = plain_.read();
      for (Painter& painter : painters) {
        if (painter.row.triangles == 0 || !painter.wanted) continue;
        if (painter.scene != nullptr) {
          look(painter, at, expected);
        } else {
          add_difference(painter.row, planes_->changed(at, expected), expected);
        }
      }
    }
  }

  /// Adds to the mean over the pictures.
  void add(std::optional<double>& to, double value) const {
    to = to.value_or(0) + value / options_.pictures;
  }

  void add_difference(FramesRow& row, const DrawnPicture& picture,
                      const DrawnPicture& expected) const {
    const PictureDifference difference = difference_of(picture, expected);
    add(row.seam_pixels, static_cast<double>(difference.seam_pixels));
    add(row.pinhole_pixels, static_cast<double>(difference.pinhole_pixels));
  }

  void look(Painter& painter, const Camera& at, const DrawnPicture& expected) {
    FramesRow& row = painter.row;
    const auto drawn = static_cast<double>(plain_.fragments_drawn(*painter.scene, at));
    const DrawnPicture picture = plain_.read();
    const auto covered = static_cast<double>(covered_pixels(picture));
    add(row.covered_pixels, covered);
    add_difference(row, picture, expected);
    if (covered == 0) return;  // avoids a division by zero
    add(row.overdraw, drawn / covered);
    add(row.depth_complexity,
        static_cast<double>(plain_.fragments_covered(*painter.scene, at)) / covered);
    if (const auto lanes = plain_.lanes_shaded(*painter.scene, at)) add(row.lanes, *lanes / drawn);
  }

  const FramesOptions& options_;
  FramesResult result_;
  std::array<int, 3> size_{};           // of the present world, in voxels
  std::unique_ptr<GlContext> context_;  // outlives what was made in it
  PlainRenderer plain_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<ProductPlanes> planes_;
  std::vector<std::unique_ptr<PlainScene>> scenes_;
};

}  // namespace

Result<FramesResult, std::string> run_frames_bench(const FramesOptions& options,
                                                   std::ostream& progress) {
  std::vector<std::string> names;
  for (const std::string& name : frames_world_names()) {
    const auto is_wanted = [&](const std::string& world) {
      return world == name || (world == "scenarios" && name != "luanti");
    };
    if (options.worlds.empty() ||
        std::any_of(options.worlds.begin(), options.worlds.end(), is_wanted)) {
      names.push_back(name);
    }
  }
  try {
    FramesBench bench(options);
    for (const std::string& name : names) {
      const std::uint64_t start = now_ns();
      const auto world = frames_world(name, options.luanti);
      if (!world) return failure(world.error());
      bench.measure(*world);
      fmt::print(progress, "{}: {} chunks, {:.1f} s\n", name, world->chunks.size(),
                 static_cast<double>(now_ns() - start) * 1e-9);
      progress.flush();
    }
    return bench.take_result();
  } catch (const std::runtime_error& error) {  // the platform and the renderer throw
    return failure(error.what());
  }
}

}  // namespace runstone::bench
