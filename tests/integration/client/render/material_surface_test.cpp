// How the looks of materials are drawn. The cases draw off screen. If there is no OpenGL context,
// they say so with WARN and pass.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/render/day_light.hpp"
#include "client/render/renderer.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"

namespace runstone {
namespace {

constexpr int kSurfaceEdge = 16;

/// A floor of one material below y = 4, drawn with any look.
class Floor {
 public:
  Floor() {
    std::string tried;
    context_ = make_egl_surfaceless_context(tried);
    if (!context_) WARN("no context: " << tried);
  }
  bool can_draw() const { return context_ != nullptr; }

  Image draw(const MaterialLook& look, const Camera& camera, double time_of_day = 0.4) const {
    return draw_after(look, look, camera, time_of_day);
  }
  /// Draws with another look than the material had when the floor was uploaded.
  Image draw_after(const MaterialLook& before, const MaterialLook& look, const Camera& camera,
                   double time_of_day) const {
    const MaterialTable table = table_of(look);
    RunChunk chunk = uniform_chunk(Extent::cube(kSurfaceEdge), kEmpty, AxisOrder::xzy);
    REQUIRE(fill(chunk, 0, kSurfaceEdge * kSurfaceEdge * 4, 1));
    RdmScratch scratch;
    ChunkMesh mesh;
    mesh_rdm(chunk, {}, VisibilityTable(visibilities(table)), scratch, mesh);
    Renderer renderer(context_->loader());
    renderer.set_materials(table_of(before));
    renderer.upload({0, {0, 0, 0}}, kSurfaceEdge, mesh, &chunk);
    renderer.set_materials(table);
    FrameContents contents;
    contents.look.time_of_day = time_of_day;
    renderer.draw(camera, 160, 120, contents);
    renderer.finish();
    return renderer.read_image();
  }

 private:
  /// Returns a table with one material, whose id is 1.
  static MaterialTable table_of(const MaterialLook& look) {
    MaterialTable table;
    const auto added =
        table.add({"m", {150, 140, 130, 255}, Visibility::opaque, {}, MaterialBody::solid, look});
    REQUIRE(added.has_value());
    REQUIRE(*added == 1);
    return table;
  }

  std::unique_ptr<GlContext> context_;
};

/// Looks straight down on some voxels.
Camera close_above() {
  Camera camera;
  camera.x = camera.z = 8;
  camera.y = 7;
  camera.pitch = -M_PI / 2;
  return camera;
}

double mean(const Image& image) {
  double sum = 0;
  for (const std::uint8_t value : image.rgb) sum += value;
  return sum / static_cast<double>(image.rgb.size());
}

/// Returns the brightness of the middle of the picture.
int middle(const Image& image) {
  const std::size_t at =
      (static_cast<std::size_t>(image.height / 2) * static_cast<std::size_t>(image.width) +
       static_cast<std::size_t>(image.width / 2)) *
      3;
  return image.rgb[at] + image.rgb[at + 1] + image.rgb[at + 2];
}

}  // namespace

TEST_CASE("each pattern has a picture of its own", "[render]") {
  const Floor floor;
  if (!floor.can_draw()) return;
  std::set<std::vector<std::uint8_t>> pictures;
  MaterialLook look{0, 0, 100, 0, MaterialPattern::none};
  constexpr auto kOfPlants = static_cast<std::uint8_t>(MaterialPattern::blades);
  for (std::uint8_t pattern = 0; pattern < kMaterialPatterns; ++pattern) {
    look.pattern = static_cast<MaterialPattern>(pattern);
    const Image image = floor.draw(look, close_above());
    pictures.insert({image.rgb.begin(), image.rgb.end()});
  }
  // A floor shows the patterns of plants as none.
  CHECK(pictures.size() == kOfPlants);
}

TEST_CASE("variation and grain make a face uneven", "[render]") {
  const Floor floor;
  if (!floor.can_draw()) return;
  const auto shades = [&](const MaterialLook& look) {
    const Image image = floor.draw(look, close_above());
    std::set<int> out;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3) out.insert(image.rgb[i]);
    return out.size();
  };
  const std::size_t even = shades({0, 0, 100, 0});
  CHECK(shades({40, 0, 100, 0}) > even);
  CHECK(shades({0, 40, 100, 0}) > even);
}

TEST_CASE("a material that gives off light is bright at night", "[render]") {
  const Floor floor;
  if (!floor.can_draw()) return;
  constexpr double kMidnight = 0;
  const double dark = mean(floor.draw({0, 0, 100, 0}, close_above(), kMidnight));
  CHECK(mean(floor.draw({0, 0, 100, 100}, close_above(), kMidnight)) > dark + 60);
}

TEST_CASE("a smooth material mirrors the sun, and a matt one does not", "[render]") {
  const Floor floor;
  if (!floor.can_draw()) return;
  constexpr double kMorning = 0.33;
  const glm::vec3 sun = day_light(kMorning, 100).sun_direction;
  // The sight is reflected by the floor towards the sun, and meets it at (8, 4, 8).
  Camera camera;
  camera.yaw = std::atan2(sun.x, sun.z);
  camera.pitch = -std::asin(sun.y);
  camera.x = 8 - 5 * sun.x;
  camera.y = 4 + 5 * sun.y;
  camera.z = 8 - 5 * sun.z;
  const int matt = middle(floor.draw({0, 0, 100, 0}, camera, kMorning));
  CHECK(middle(floor.draw({0, 0, 70, 0}, camera, kMorning)) == matt);
  const int smooth = middle(floor.draw({0, 0, 20, 0}, camera, kMorning));
  CHECK(smooth > matt + 60);
  // A chunk that is there follows the material.
  CHECK(middle(floor.draw_after({0, 0, 100, 0}, {0, 0, 20, 0}, camera, kMorning)) == smooth);
  // Away from the mirrored sun the floor is much darker than in it.
  Camera away = camera;
  away.yaw += 1.2;
  CHECK(middle(floor.draw({0, 0, 20, 0}, away, kMorning)) < smooth - 40);
}

}  // namespace runstone
