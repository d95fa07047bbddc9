// The silhouettes of plants, in the picture and in their shadows. The cases draw off screen. If
// there is no OpenGL context, they say so with WARN and pass.
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/mesh/quad.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "common/shapes/shape_faces.hpp"
#include "tests/integration/client/render/different_pixels.hpp"

namespace runstone::silhouette_test {
namespace {

constexpr std::int32_t kEdge = 16;
constexpr int kSide = 200;            // pixels of a picture
constexpr double kNarrowAngle = 0.1;  // radians: lines that are parallel look parallel
constexpr Material kFloor = 1, kPlant = 2;
constexpr std::array kSilhouettes = {MaterialPattern::blades, MaterialPattern::flower,
                                     MaterialPattern::foliage};

MaterialTable floor_and_plant(MaterialPattern pattern) {
  MaterialTable out;
  MaterialInfo row{"floor", {160, 160, 160, 255}, Visibility::opaque, {}};
  row.look = MaterialLook{0, 0, 100, 0, MaterialPattern::none};
  REQUIRE(out.add(row).value() == kFloor);
  row = {"plant", {220, 30, 30, 255}, Visibility::opaque, {}};
  row.look = MaterialLook{0, 0, 100, 0, pattern};
  row.shape = {ShapeForm::crossed, {ShapeBox{}}};
  REQUIRE(out.add(row).value() == kPlant);
  return out;
}

/// Returns a floor whose upper side is at y = 1, and a plant in the voxel (8, `plant_y`, 8) if that
/// is not 0.
ChunkMesh floor_with_plant(std::uint8_t plant_y) {
  const MaterialTable materials = floor_and_plant(MaterialPattern::none);
  RunChunk chunk = uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::yzx);
  for (std::uint8_t x = 0; x < kEdge; ++x) {
    for (std::uint8_t z = 0; z < kEdge; ++z)
      fill(chunk, index_of(LocalPos{x, 0, z}, chunk.extent, chunk.order), 1, kFloor);
  }
  RdmScratch scratch;
  ChunkMesh out;
  mesh_rdm(chunk, {}, VisibilityTable(visibilities(materials)), scratch, out);
  if (plant_y == 0) return out;
  const ShapeFaces faces(materials[kPlant].shape);
  for (std::size_t i = 0; i < faces.faces().size(); ++i) {
    QuadFields quad{8, plant_y, 8, 1, 1, faces.faces()[i].direction, kPlant};
    quad.face = static_cast<std::uint16_t>(i + 1);
    out.shapes.opaque.push_back(pack(quad));
  }
  return out;
}

/// A camera that sees a square of `width` voxels around a place, from far before it.
Camera camera_at(std::array<double, 3> place, double yaw, double pitch, double width) {
  Camera out;
  out.yaw = yaw;
  out.pitch = pitch;
  out.fov_y = kNarrowAngle;
  const double distance = width / 2 / std::tan(kNarrowAngle / 2), flat = std::cos(pitch);
  out.x = place[0] - distance * std::sin(yaw) * flat;
  out.y = place[1] - distance * std::sin(pitch);
  out.z = place[2] - distance * std::cos(yaw) * flat;
  return out;
}

class PlantScene {
 public:
  PlantScene(GlContext& context, MaterialPattern pattern) : renderer_(context.loader()) {
    set_pattern(pattern);
    contents_.look.time_of_day = 0.375;  // the morning sun stands at +x
  }
  void set_pattern(MaterialPattern pattern) { renderer_.set_materials(floor_and_plant(pattern)); }
  void set_plant(std::uint8_t y) { renderer_.upload({0, {0, 0, 0}}, kEdge, floor_with_plant(y)); }
  void set_textures(const DrawnTexturesPtr& textures) { renderer_.set_textures(textures); }
  Image draw(const Camera& camera) {
    renderer_.draw(camera, kSide, kSide, contents_);
    renderer_.finish();
    return renderer_.read_image();
  }

 private:
  Renderer renderer_;
  FrameContents contents_;
};

using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

std::unique_ptr<GlContext> context_or_warn(MakeContext make) {
  std::string tried;
  auto context = make(tried);
  if (!context) WARN("no context: " << tried);
  return context;
}

/// Returns true if a pixel shows in `image` what it shows in `other`, but for rounding.
bool is_equal(const Image& image, const Image& other, std::size_t pixel) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (std::abs(int{image.rgb[3 * pixel + c]} - int{other.rgb[3 * pixel + c]}) > 3) return false;
  }
  return true;
}

/// The pixels of a square of two voxels around the middle of the plant, seen across one of its
/// planes, which is as wide as the diagonal of a voxel. The other plane is a line.
struct PlaneView {
  static constexpr double kWidth = 2;
  Camera camera = camera_at({8.5, 8.5, 8.5}, M_PI / 4, 0, kWidth);
  /// Returns the number of a pixel, in voxels right of the middle and above it.
  static std::size_t pixel(double right, double up) {
    const auto place = [](double voxels) {
      return static_cast<std::size_t>(std::lround(kSide * (0.5 + voxels / kWidth)));
    };
    return place(-up) * kSide + place(right);
  }
  /// Returns the pixels of the plane, without its border.
  static std::vector<std::size_t> pixels() {
    std::vector<std::size_t> out;
    for (double right = -0.68; right < 0.68; right += kWidth / kSide) {
      for (double up = -0.48; up < 0.48; up += kWidth / kSide) out.push_back(pixel(right, up));
    }
    return out;
  }
};

/// The camera above a plant on the floor, whose shadow lies at -x of it. It is so near that the floor
/// is in the inner shadow map.
Camera above_shadow() {
  Camera out;
  out.x = 8;
  out.y = 9;
  out.z = 8.5;
  out.pitch = -M_PI / 2;
  out.fov_y = 0.5;
  return out;
}

/// Returns a texture for all sides of the plant, whose left half is a hole.
DrawnTexturesPtr half_a_picture() {
  TexturePicture picture{16, {}};
  for (unsigned i = 0; i < 16 * 16; ++i) {
    const bool is_hole = i % 16 < 8;
    for (const int value : {20, 200, 20, is_hole ? 0 : 255})
      picture.rgba.push_back(static_cast<std::uint8_t>(value));
  }
  auto out = std::make_shared<DrawnTextures>();
  TextureTable table;
  TextureEntry entry;
  entry.uses = {{kPlant, kAllTextureSides}};
  REQUIRE(table.add(entry).has_value());
  out->table = std::make_shared<const TextureTable>(table);
  out->pictures = {std::make_shared<const TextureLevels>(texture_levels(picture))};
  return out;
}

}  // namespace

TEST_CASE("the sky is seen through the silhouette of a plant, on every headless path", "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = context_or_warn(make);
  if (!context) return;
  const PlaneView view;
  PlantScene scene(*context, MaterialPattern::none);
  scene.set_plant(0);
  const Image sky = scene.draw(view.camera);
  const auto count_sky = [&](MaterialPattern pattern) {
    scene.set_pattern(pattern);
    scene.set_plant(8);
    const Image image = scene.draw(view.camera);
    std::size_t out = 0;
    for (const std::size_t pixel : PlaneView::pixels()) out += is_equal(image, sky, pixel) ? 1 : 0;
    return out;
  };
  const std::size_t all = PlaneView::pixels().size();
  CHECK(count_sky(MaterialPattern::none) == 0);
  for (const MaterialPattern pattern : kSilhouettes) {
    const std::size_t seen = count_sky(pattern);
    CAPTURE(context->name(), static_cast<int>(pattern), seen, all);
    CHECK(seen > all / 10);
    CHECK(seen < all - all / 10);
  }
}

TEST_CASE("a flower is a blossom on a stalk", "[render]") {
  const auto context = context_or_warn(&make_osmesa_context);
  if (!context) return;
  const PlaneView view;
  PlantScene scene(*context, MaterialPattern::flower);
  scene.set_plant(0);
  const Image sky = scene.draw(view.camera);
  scene.set_plant(8);
  const Image flower = scene.draw(view.camera);
  // A cell is a sixteenth of the plane. The blossom has a radius of four cells, and its middle is
  // four cells above that of the plane.
  const double cell_right = std::sqrt(2.0) / 16, cell_up = 1.0 / 16;
  const auto shown = [&](double right, double up) {
    const std::size_t pixel = PlaneView::pixel(right * cell_right, up * cell_up);
    if (is_equal(flower, sky, pixel)) return "sky";
    return flower.rgb[3 * pixel] > flower.rgb[3 * pixel + 1] ? "blossom" : "green";
  };
  for (const double side : {-1.0, 1.0}) {
    CAPTURE(side);
    CHECK(shown(2.5 * side, 4) == std::string("blossom"));
    CHECK(shown(6 * side, 4) == std::string("sky"));
    CHECK(shown(5 * side, 7) == std::string("sky"));
    CHECK(shown(3 * side, -2) == std::string("sky"));      // beside the stalk
    CHECK(shown(2 * side, -4.5) == std::string("green"));  // a leaf
  }
  CHECK(shown(0, -1.5) == std::string("green"));
}

TEST_CASE("the shadow of a plant has the holes of its silhouette", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  PlantScene scene(*context, MaterialPattern::none);
  scene.set_plant(0);
  const Image open = scene.draw(above_shadow());
  const auto with = [&](MaterialPattern pattern) {
    scene.set_pattern(pattern);
    scene.set_plant(1);
    return scene.draw(above_shadow());
  };
  const auto is_dark = [&open](const Image& image, std::size_t pixel) {
    return image.rgb[3 * pixel + 1] + 15 < open.rgb[3 * pixel + 1];
  };
  const Image whole = with(MaterialPattern::none);
  std::vector<std::size_t> shadow;
  for (std::size_t pixel = 0; pixel < std::size_t{kSide} * kSide; ++pixel) {
    if (is_dark(whole, pixel)) shadow.push_back(pixel);
  }
  REQUIRE(shadow.size() > 1000);
  for (const MaterialPattern pattern : kSilhouettes) {
    const Image image = with(pattern);
    std::size_t lit = 0;
    for (const std::size_t pixel : shadow) lit += is_dark(image, pixel) ? 0 : 1;
    CAPTURE(static_cast<int>(pattern), lit, shadow.size());
    CHECK(lit > shadow.size() / 10);
    CHECK(lit < shadow.size() - shadow.size() / 10);
  }
}

TEST_CASE("shadows follow the materials and the textures without a new mesh", "[render]") {
  const auto context = context_or_warn(&make_egl_surfaceless_context);
  if (!context) return;
  PlantScene scene(*context, MaterialPattern::none);
  scene.set_plant(1);
  const Image whole = scene.draw(above_shadow());
  const auto anew = [&](MaterialPattern pattern, const DrawnTexturesPtr& textures) {
    PlantScene other(*context, pattern);
    other.set_textures(textures);
    other.set_plant(1);
    return other.draw(above_shadow());
  };
  scene.set_pattern(MaterialPattern::blades);
  const Image blades = scene.draw(above_shadow());
  CHECK(different_pixels(blades, anew(MaterialPattern::blades, nullptr)) == 0);
  CHECK(different_pixels(blades, whole) > 300);
  const DrawnTexturesPtr textures = half_a_picture();
  scene.set_textures(textures);
  const Image textured = scene.draw(above_shadow());
  CHECK(different_pixels(textured, anew(MaterialPattern::blades, textures)) == 0);
  CHECK(different_pixels(textured, blades) > 300);
  scene.set_textures(nullptr);
  CHECK(different_pixels(scene.draw(above_shadow()), blades) == 0);
}

}  // namespace runstone::silhouette_test
