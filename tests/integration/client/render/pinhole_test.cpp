// Pinholes: pixels inside a face through which something behind it is seen, where merged quads meet
// in T-junctions. The same voxels are drawn as merged quads and as one quad for each face, which has
// no T-junctions. The colour of a pixel tells the plane of its face.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/integration/client/render/pinholes.hpp"
#include "tests/support/mesh/plane_colours.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kHillEdge = 32;
constexpr int kHillChunks = 4;  // along x and z

/// Hills with steps, holes and pillars.
RunChunk hill_chunk(ChunkCoord at) {
  RunChunk chunk = uniform_chunk(Extent::cube(kHillEdge), kEmpty, AxisOrder::yxz);
  for (std::int32_t x = 0; x < kHillEdge; ++x) {
    for (std::int32_t z = 0; z < kHillEdge; ++z) {
      const std::int32_t wx = at.x * kHillEdge + x, wz = at.z * kHillEdge + z;
      SplitMix64 rng(static_cast<std::uint64_t>(wx * 7919 + wz));
      int height = static_cast<int>(14 + 7 * std::sin(0.09 * wx) + 6 * std::cos(0.07 * wz));
      if (rng.below(40) == 0) height += static_cast<int>(rng.below(4));
      if (rng.below(60) == 0) height = 2;
      const LocalPos bottom{static_cast<std::uint8_t>(x), 0, static_cast<std::uint8_t>(z)};
      fill(chunk, index_of(bottom, chunk.extent, chunk.order),
           static_cast<std::uint32_t>(std::clamp(height, 1, kHillEdge)), 1);
    }
  }
  return chunk;
}

using Meshes = std::map<ChunkCoord, ChunkMesh>;

Meshes hill_meshes() {
  std::map<ChunkCoord, RunChunk> chunks;
  for (std::int32_t x = 0; x < kHillChunks; ++x) {
    for (std::int32_t z = 0; z < kHillChunks; ++z)
      chunks.emplace(ChunkCoord{x, 0, z}, hill_chunk({x, 0, z}));
  }
  const VisibilityTable visibility(visibilities(plane_colours()));
  RdmScratch scratch;
  Meshes out;
  for (const auto& [at, chunk] : chunks) {
    MeshNeighbours beside{};
    for (int d = 0; d < kDirectionCount; ++d) {
      const auto found = chunks.find(neighbour(at, static_cast<Direction>(d)));
      if (found != chunks.end()) beside[static_cast<std::size_t>(d)] = &found->second;
    }
    mesh_rdm(chunk, beside, visibility, scratch, out[at]);
  }
  return out;
}

/// Draws the meshes from cameras above the hills and near the ground.
class PlanePictures {
 public:
  PlanePictures(GlContext& context, const Meshes& meshes, bool into_faces)
      : renderer_(context.loader()) {
    renderer_.set_materials(plane_colours());
    for (const auto& [at, mesh] : meshes)
      renderer_.upload({0, at}, kHillEdge,
                       coloured_by_plane(mesh, origin_of(at, kHillEdge), into_faces));
  }
  Image draw(int number, Quality quality) {
    Camera camera;
    const double turn = 0.37 * number;
    constexpr double kMiddle = kHillChunks * kHillEdge / 2.0;
    camera.x = kMiddle + 60 * std::sin(turn) + 0.13;
    camera.z = kMiddle + 60 * std::cos(turn) + 0.29;
    camera.y = number % 2 == 0 ? 30.7 : 55.1;
    camera.yaw = turn + M_PI + 0.1;
    camera.pitch = number % 2 == 0 ? -0.12 : -0.5;
    FrameContents contents;
    contents.look.quality = quality;
    contents.look.time_of_day = 0.5;
    renderer_.draw(camera, 640, 360, contents);
    renderer_.finish();
    return renderer_.read_image();
  }

 private:
  Renderer renderer_;
};

}  // namespace

TEST_CASE("merged quads have no pinholes where they meet, on every headless path", "[render]") {
  using Make = std::unique_ptr<GlContext> (*)(std::string&);
  const Make make = GENERATE(Make{&make_egl_surfaceless_context},
                             Make{&make_egl_surfaceless_es_context}, Make{&make_osmesa_context});
  std::string tried;
  const auto context = make(tried);
  if (!context) {
    WARN("no context: " << tried);
    return;
  }
  Meshes meshes = hill_meshes();
  std::vector<Image> merged, faces;
  {
    PlanePictures pictures(*context, meshes, false);
    for (int number = 0; number < 6; ++number)
      merged.push_back(pictures.draw(number, number % 3 == 0 ? Quality::high : Quality::low));
  }
  {
    PlanePictures pictures(*context, meshes, true);
    for (int number = 0; number < 6; ++number)
      faces.push_back(pictures.draw(number, number % 3 == 0 ? Quality::high : Quality::low));
  }
  std::size_t total = 0;
  for (std::size_t i = 0; i < merged.size(); ++i) total += pinholes(merged[i], faces[i]);
  CHECK(total == 0);
  // The count is not 0 if faces are missing.
  for (auto& [at, mesh] : meshes) {
    const std::size_t last = mesh.opaque.first.size() - 1;
    mesh.opaque.quads.resize(mesh.opaque.quads.size() - 40);
    for (std::size_t l = 0; l <= last; ++l) {
      mesh.opaque.first[l] =
          std::min(mesh.opaque.first[l], static_cast<std::uint32_t>(mesh.opaque.quads.size()));
    }
  }
  PlanePictures lacking(*context, meshes, false);
  CHECK(pinholes(lacking.draw(0, Quality::low), merged[0]) > 0);
}

}  // namespace runstone
