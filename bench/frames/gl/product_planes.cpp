#include "bench/frames/gl/product_planes.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/support/mesh/plane_colours.hpp"

namespace runstone::bench {
namespace {

/// Pixels of one plane differ less than this in each channel, and planes differ more.
constexpr int kTolerance = 12;

Image draw_planes(Renderer& renderer, Camera camera, const DrawnPicture& size) {
  camera.far *= 4;  // no fog
  FrameContents contents;
  contents.look.time_of_day = 0.5;
  contents.look.quality = Quality::low;
  renderer.draw(camera, size.width, size.height, contents);
  renderer.finish();
  return renderer.read_image();
}

}  // namespace

ProductPlanes::ProductPlanes(GlContextLoader loader, const FramesWorld& world)
    : merged_(loader), faces_(loader) {
  merged_.set_materials(plane_colours());
  faces_.set_materials(plane_colours());
  const auto edge = static_cast<std::int32_t>(world.edge);
  RdmScratch scratch;
  ChunkMesh mesh;
  for (const FramesChunk& chunk : world.chunks) {
    mesh_rdm(chunk.volume.scene.chunk, chunk.volume.scene.pointers(), {}, *world.visibility,
             scratch, mesh);
    const VoxelPos origin = origin_of(chunk.at, edge);
    merged_.upload({0, chunk.at}, edge, coloured_by_plane(mesh, origin, false));
    faces_.upload({0, chunk.at}, edge, coloured_by_plane(mesh, origin, true));
  }
}

DrawnPicture ProductPlanes::changed(const Camera& camera, const DrawnPicture& expected) {
  const Image merged = draw_planes(merged_, camera, expected);
  const Image faces = draw_planes(faces_, camera, expected);
  DrawnPicture out = expected;
  const auto width = static_cast<std::size_t>(expected.width);
  const auto height = static_cast<std::size_t>(expected.height);
  for (std::size_t y = 0; y < height; ++y) {
    for (std::size_t x = 0; x < width; ++x) {
      int most = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t at = 3 * (y * width + x) + c;
        most = std::max(most, std::abs(int{merged.rgb[at]} - int{faces.rgb[at]}));
      }
      // The rows of a DrawnPicture begin at the bottom.
      if (most >= kTolerance) out.pixels[(height - 1 - y) * width + x] ^= ~std::uint32_t{0};
    }
  }
  return out;
}

}  // namespace runstone::bench
