// GroundScene: a chunk with a floor and boxes, drawn off screen.
#pragma once
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "client/platform/egl_context.hpp"
#include "client/render/renderer.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone::test {

/// Warns if there is no OpenGL context; then draws() is false.
class GroundScene {
 public:
  static constexpr std::int32_t kEdge = 32;
  static constexpr int kWidth = 160, kHeight = 120;

  explicit GroundScene(MaterialTable materials)
      : materials_(std::move(materials)),
        chunk_(uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::xzy)) {
    std::string tried;
    context_ = make_egl_surfaceless_context(tried);
    if (!context_) {
      WARN("no context: " << tried);
      return;
    }
    use_loader(context_->loader());
    place_camera();
    contents.look.quality = Quality::medium;
  }
  bool draws() const { return context_ != nullptr; }
  /// Makes the renderer anew, with these functions of OpenGL.
  void use_loader(GlContextLoader functions) {
    renderer_.reset();
    renderer_ = std::make_unique<Renderer>(functions);
    renderer_->set_materials(materials_);
    upload();
  }
  /// Moves the chunk and the camera.
  void move_to(ChunkCoord at) {
    renderer_->remove({0, at_});
    at_ = at;
    place_camera();
    upload();
  }
  void set_materials(MaterialTable materials) {
    materials_ = std::move(materials);
    renderer_->set_materials(materials_);
    upload();
  }
  GlContextLoader loader() const { return context_->loader(); }

  /// Sets a box in coordinates of the chunk.
  void set(const VoxelBox& box, Material material) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          fill(chunk_, index_of(local_of({x, y, z}, kEdge), chunk_.extent, chunk_.order), 1,
               material);
        }
      }
    }
    upload();
  }
  void set_floor(Material material) { set({{0, 0, 0}, {kEdge, 4, kEdge}}, material); }

  Image draw() {
    stats = renderer_->draw(camera, kWidth, kHeight, contents);
    renderer_->finish();
    return renderer_->read_image();
  }

  Camera camera;
  FrameContents contents;
  RenderStats stats;  // of the last picture

 private:
  void place_camera() {
    const VoxelPos origin = origin_of(at_, kEdge);
    camera.x = origin.x + 16;
    camera.y = origin.y + 10;
    camera.z = origin.z + 16;
  }
  void upload() {
    RdmScratch scratch;
    ChunkMesh mesh;
    mesh_rdm(chunk_, {}, VisibilityTable(visibilities(materials_)), scratch, mesh);
    renderer_->upload({0, at_}, kEdge, mesh, &chunk_);
  }

  MaterialTable materials_;
  ChunkCoord at_{0, 0, 0};
  RunChunk chunk_;
  std::unique_ptr<GlContext> context_;
  std::unique_ptr<Renderer> renderer_;  // destroyed before its context
};

/// Returns the colour of a pixel. `u` and `v` are 0 to 1 from the upper left corner.
inline std::array<int, 3> colour_of(const Image& image, double u, double v) {
  const auto x = static_cast<std::size_t>(u * image.width);
  const auto y = static_cast<std::size_t>(v * image.height);
  const std::size_t at = (y * static_cast<std::size_t>(image.width) + x) * 3;
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// Returns the mean colour of a picture.
inline std::array<double, 3> mean_colour(const Image& image) {
  std::array<double, 3> out{};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) out[i % 3] += image.rgb[i];
  for (double& channel : out) channel /= static_cast<double>(image.rgb.size()) / 3;
  return out;
}

/// Returns a table with one material.
inline MaterialTable one_material(MaterialColour colour, const MaterialLook& look) {
  MaterialTable out;
  REQUIRE(out.add({"m", colour, Visibility::opaque, {}, MaterialBody::solid, look}).has_value());
  return out;
}

}  // namespace runstone::test
