// Pinholes: pixels inside a face through which something behind it is seen, where merged quads meet
// in T-junctions. The same voxels are drawn as merged quads and as one quad for each face, which has
// no T-junctions. The colour of a pixel tells the plane of its face.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kHillEdge = 32;
constexpr int kHillChunks = 4;  // along x and z
constexpr Material kPlaneMaterials = 4000;

/// Materials without variation whose colours are far apart.
MaterialTable plane_materials() {
  MaterialTable table;
  SplitMix64 rng(77);
  for (int id = 1; id <= kPlaneMaterials; ++id) {
    const auto channel = [&rng] { return static_cast<std::uint8_t>(40 + 43 * rng.below(6)); };
    REQUIRE(table
                .add({"glass " + std::to_string(id),
                      {channel(), channel(), channel(), 255},
                      Visibility::opaque,
                      {}})
                .has_value());
  }
  return table;
}

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

/// Returns the quads with the material of their plane in the world, each cut into its faces if `cut`.
ChunkMesh coded(const ChunkMesh& mesh, ChunkCoord at, bool cut) {
  const VoxelPos origin = origin_of(at, kHillEdge);
  ChunkMesh out;
  std::size_t layer = 0;
  for (std::size_t i = 0; i < mesh.opaque.quads.size(); ++i) {
    while (mesh.opaque.first[layer + 1] <= i) ++layer;
    QuadFields quad = unpack(mesh.opaque.quads[i]);
    const Axis axis = axis_of(quad.direction);
    const std::array<std::int32_t, 3> place = {origin.x + quad.x, origin.y + quad.y,
                                               origin.z + quad.z};
    const auto plane = static_cast<std::uint64_t>(place[static_cast<std::size_t>(axis)]);
    SplitMix64 rng(plane * 6 + static_cast<std::uint64_t>(quad.direction));
    quad.material = static_cast<Material>(1 + rng.below(kPlaneMaterials));
    const int columns = cut ? quad.width : 1, rows = cut ? quad.height : 1;
    if (cut) quad.width = quad.height = 1;
    const std::array<std::uint8_t*, 3> from = {&quad.x, &quad.y, &quad.z};
    std::uint8_t& u = *from[static_cast<std::size_t>(u_axis_of(axis))];
    std::uint8_t& v = *from[static_cast<std::size_t>(v_axis_of(axis))];
    const std::uint8_t u0 = u, v0 = v;
    for (int face = 0; face < columns * rows; ++face) {
      u = static_cast<std::uint8_t>(u0 + face % columns);
      v = static_cast<std::uint8_t>(v0 + face / columns);
      out.opaque.quads.push_back(pack(quad));
    }
    for (std::size_t l = layer + 1; l < out.opaque.first.size(); ++l)
      out.opaque.first[l] += static_cast<std::uint32_t>(columns * rows);
  }
  return out;
}

using Meshes = std::map<ChunkCoord, ChunkMesh>;

Meshes hill_meshes() {
  std::map<ChunkCoord, RunChunk> chunks;
  for (std::int32_t x = 0; x < kHillChunks; ++x) {
    for (std::int32_t z = 0; z < kHillChunks; ++z)
      chunks.emplace(ChunkCoord{x, 0, z}, hill_chunk({x, 0, z}));
  }
  const VisibilityTable visibility(visibilities(plane_materials()));
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
  PlanePictures(GlContext& context, const Meshes& meshes, bool cut) : renderer_(context.loader()) {
    renderer_.set_materials(plane_materials());
    for (const auto& [at, mesh] : meshes)
      renderer_.upload({0, at}, kHillEdge, coded(mesh, at, cut));
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

/// Returns the number of pixels of another colour than in the other picture, where that one has
/// nearly the same colour all around.
std::size_t pinholes(const Image& picture, const Image& from) {
  const auto difference = [](const Image& a, int ax, int ay, const Image& b, int bx, int by) {
    int most = 0;
    for (int c = 0; c < 3; ++c) {
      const auto at = [c](const Image& image, int x, int y) {
        return int{image.rgb[static_cast<std::size_t>((y * image.width + x) * 3 + c)]};
      };
      most = std::max(most, std::abs(at(a, ax, ay) - at(b, bx, by)));
    }
    return most;
  };
  std::size_t out = 0;
  for (int y = 1; y + 1 < from.height; ++y) {
    for (int x = 1; x + 1 < from.width; ++x) {
      if (difference(picture, x, y, from, x, y) < 12) continue;
      bool is_inside = true;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx)
          is_inside = is_inside && difference(from, x + dx, y + dy, from, x, y) < 10;
      }
      out += is_inside ? 1 : 0;
    }
  }
  return out;
}

}  // namespace

TEST_CASE("merged quads have no pinholes where they meet, on every headless path", "[render]") {
  using Make = std::unique_ptr<GlContext> (*)(std::string&);
  const Make make = GENERATE(Make{&make_egl_surfaceless_context}, Make{&make_osmesa_context});
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
    for (int number = 0; number < 12; ++number)
      merged.push_back(pictures.draw(number, number % 3 == 0 ? Quality::high : Quality::low));
  }
  {
    PlanePictures pictures(*context, meshes, true);
    for (int number = 0; number < 12; ++number)
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
