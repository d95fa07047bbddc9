// Light of sky and lamps, the eye in a solid or a liquid, and glass of several directions. The cases
// draw off screen. If there is no OpenGL context, they say so with WARN and pass.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "client/platform/egl_context.hpp"
#include "client/platform/osmesa_context.hpp"
#include "client/render/renderer.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/mesh/visibility.hpp"
#include "tests/integration/client/render/different_pixels.hpp"

namespace runstone {
namespace {

enum : Material { kAir, kStone, kLamp, kWater, kRedGlass, kBlueGlass };

MaterialTable scene_materials() {
  MaterialTable table;
  const auto add = [&](const char* name, MaterialColour colour, Visibility visibility,
                       MaterialBody body = MaterialBody::solid) {
    REQUIRE(table.add({name, colour, visibility, {}, body}).has_value());
  };
  add("stone", {150, 150, 150, 255}, Visibility::opaque);
  add("lamp", {255, 220, 150, 255}, Visibility::opaque);
  add("water", {30, 80, 220, 160}, Visibility::transparent, MaterialBody::liquid);
  add("red glass", {230, 20, 20, 128}, Visibility::transparent);
  add("blue glass", {20, 20, 230, 128}, Visibility::transparent);
  return table;
}

/// A world of 2 x 1 x 1 chunks of edge 32, drawn by the product's mesher and renderer.
class LitScene {
 public:
  static constexpr std::int32_t kEdge = 32;

  explicit LitScene(GlContext& context)
      : materials_(scene_materials()),
        visibility_(visibilities(materials_)),
        renderer_(context.loader()) {
    renderer_.set_materials(materials_);
    for (std::int32_t x = 0; x < 2; ++x)
      chunks_.emplace(x, uniform_chunk(Extent::cube(kEdge), kAir, AxisOrder::zxy));
    camera.y = 2;
    contents.look.time_of_day = 0.5;
  }

  void set_box(const VoxelBox& box, Material material) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
          RunChunk& chunk = chunks_.at(chunk_of({x, y, z}, kEdge).x);
          fill(chunk, index_of(local_of({x, y, z}, kEdge), chunk.extent, chunk.order), 1, material);
        }
      }
    }
  }
  void upload(std::int32_t x) {
    MeshNeighbours beside{};
    beside[static_cast<std::size_t>(x == 0 ? Direction::pos_x : Direction::neg_x)] =
        &chunks_.at(1 - x);
    ChunkMesh mesh;
    mesh_rdm(chunks_.at(x), beside, visibility_, scratch_, mesh);
    renderer_.upload({0, {x, 0, 0}}, kEdge, mesh, &chunks_.at(x));
  }
  void upload_all() {
    upload(0);
    upload(1);
  }
  void look_at(double x, double y, double z) {
    const double dx = x - camera.x, dy = y - camera.y, dz = z - camera.z;
    camera.yaw = std::atan2(dx, dz);
    camera.pitch = std::atan2(dy, std::hypot(dx, dz));
  }
  Image draw() {
    renderer_.draw(camera, 160, 120, contents);
    renderer_.finish();
    return renderer_.read_image();
  }
  /// Draws a picture towards a place and returns the colour in its middle.
  std::array<int, 3> colour_at(double x, double y, double z) {
    look_at(x, y, z);
    const Image image = draw();
    const std::size_t at =
        (static_cast<std::size_t>(image.height / 2) * static_cast<std::size_t>(image.width) +
         static_cast<std::size_t>(image.width / 2)) *
        3;
    return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
  }
  int brightness_at(double x, double y, double z) {
    const auto colour = colour_at(x, y, z);
    return colour[0] + colour[1] + colour[2];
  }

  Camera camera;
  FrameContents contents;

 private:
  MaterialTable materials_;
  VisibilityTable visibility_;
  Renderer renderer_;
  std::map<std::int32_t, RunChunk> chunks_;
  RdmScratch scratch_;
};

using MakeContext = std::unique_ptr<GlContext> (*)(std::string&);

std::unique_ptr<GlContext> scene_context(MakeContext make) {
  std::string tried;
  auto context = make(tried);
  if (!context) WARN("no context: " << tried);
  return context;
}

/// A floor with a closed room of stone in the first chunk, and a wall in it.
void build_room(LitScene& scene) {
  scene.set_box({{0, 0, 0}, {64, 4, 32}}, kStone);
  scene.set_box({{4, 4, 4}, {30, 14, 28}}, kStone);
  scene.set_box({{5, 4, 5}, {29, 13, 27}}, kAir);
  scene.set_box({{16, 4, 5}, {17, 13, 27}}, kStone);
}

}  // namespace

TEST_CASE("a roofed room is darker than outdoors, and light comes in at its door, on every path",
          "[render]") {
  const MakeContext make = GENERATE(&make_egl_surfaceless_context, &make_egl_surfaceless_es_context,
                                    &make_osmesa_context);
  const auto context = scene_context(make);
  if (!context) return;
  LitScene scene(*context);
  scene.contents.look.quality = GENERATE(Quality::medium, Quality::high);
  build_room(scene);
  scene.upload_all();
  scene.camera = {40.5, 10, 16.5};
  const int outdoors = scene.brightness_at(44.5, 4, 16.5);
  scene.camera = {26.5, 10, 16.5};
  const int indoors = scene.brightness_at(24.5, 4, 16.5);
  CAPTURE(context->name(), outdoors, indoors);
  CHECK(indoors * 3 < outdoors);
  CHECK(indoors > 15);  // not black
  // A door beside which the floor is lit by the sky, more than deep in the room.
  scene.set_box({{29, 4, 15}, {30, 8, 18}}, kAir);
  scene.upload_all();
  const int at_door = scene.brightness_at(27.5, 4, 16.5);
  const int inside = scene.brightness_at(19.5, 4, 24.5);
  CHECK(at_door > 2 * indoors);
  CHECK(at_door > inside);
  // At low quality no place is dark.
  scene.contents.look.quality = Quality::low;
  CHECK(scene.brightness_at(24.5, 4, 16.5) > 2 * indoors);
}

TEST_CASE("OpenGL ES draws lamps, shadows, water and glass as OpenGL does", "[render]") {
  const auto quality = GENERATE(Quality::low, Quality::medium, Quality::high);
  const auto picture = [&](MakeContext make) -> std::optional<Image> {
    const auto context = scene_context(make);
    if (!context) return std::nullopt;
    LitScene scene(*context);
    scene.contents.look.quality = quality;
    scene.contents.look.time_of_day = 0.4;
    build_room(scene);
    scene.set_box({{29, 4, 12}, {30, 10, 20}}, kAir);
    scene.set_box({{24, 4, 14}, {25, 5, 15}}, kLamp);
    scene.set_box({{34, 2, 6}, {50, 4, 26}}, kWater);
    scene.set_box({{33, 4, 18}, {34, 9, 22}}, kRedGlass);
    scene.set_box({{36, 4, 20}, {37, 9, 24}}, kBlueGlass);
    scene.upload_all();
    scene.camera = {52, 12, 16.5};
    scene.look_at(29, 5, 16.5);
    return scene.draw();
  };
  const auto a = picture(&make_egl_surfaceless_context);
  const auto b = picture(&make_egl_surfaceless_es_context);
  if (!a || !b) return;
  CHECK(different_pixels(*a, *b) < a->rgb.size() / 3 / 200);
}

TEST_CASE("a lamp lights a room in its colour, and not the room behind a wall", "[render]") {
  const auto context = scene_context(&make_egl_surfaceless_context);
  if (!context) return;
  LitScene scene(*context);
  build_room(scene);
  scene.upload_all();
  scene.camera = {14.5, 10, 22.5};
  const auto before = scene.colour_at(12.5, 4, 18.5);
  scene.camera = {20.5, 10, 22.5};
  const auto behind_before = scene.colour_at(18.5, 4, 18.5);
  scene.set_box({{14, 6, 16}, {15, 7, 17}}, kLamp);
  scene.upload(0);
  const auto behind = scene.colour_at(18.5, 4, 18.5);
  scene.camera = {14.5, 10, 22.5};
  const auto after = scene.colour_at(12.5, 4, 18.5);
  CHECK(after[0] > before[0] + 60);
  CHECK(after[0] > after[2] + 20);  // warm
  CHECK(std::abs(behind[0] - behind_before[0]) <= 2);
  // A gap in the wall lets the light through.
  scene.set_box({{16, 4, 15}, {17, 9, 18}}, kAir);
  scene.upload(0);
  scene.camera = {20.5, 10, 22.5};
  CHECK(scene.colour_at(18.5, 4, 18.5)[0] > behind[0] + 15);
}

TEST_CASE("a lamp across the border of a chunk goes out with the edit of that chunk alone",
          "[render]") {
  const auto context = scene_context(&make_egl_surfaceless_context);
  if (!context) return;
  LitScene scene(*context);
  scene.contents.look.time_of_day = 0;
  // As in a window: an edit is lit in the next frame there too.
  scene.contents.look.exact = GENERATE(true, false);
  scene.set_box({{0, 0, 0}, {64, 4, 32}}, kStone);
  scene.upload_all();
  scene.camera = {26.5, 12, 16.5};
  for (int frame = 0; frame < 20; ++frame) scene.draw();
  const int dark = scene.brightness_at(29.5, 4, 16.5);
  scene.set_box({{33, 4, 16}, {34, 5, 17}}, kLamp);
  scene.upload(1);
  const int lit = scene.brightness_at(29.5, 4, 16.5);
  scene.set_box({{33, 4, 16}, {34, 5, 17}}, kAir);
  scene.upload(1);
  const int dark_again = scene.brightness_at(29.5, 4, 16.5);
  CHECK(lit > dark + 60);
  CHECK(dark_again == dark);
}

TEST_CASE("an eye in a solid sees darkness and markers, and one in water sees blue", "[render]") {
  const auto context = scene_context(&make_egl_surfaceless_context);
  if (!context) return;
  LitScene scene(*context);
  scene.contents.look.quality = GENERATE(Quality::low, Quality::high);
  scene.set_box({{0, 0, 0}, {64, 16, 32}}, kStone);
  scene.set_box({{8, 4, 8}, {24, 10, 24}}, kAir);  // a cave that must not be seen
  scene.upload_all();
  scene.camera = {28.5, 7.5, 16.5};
  scene.look_at(16, 7.5, 16.5);
  const auto brightest = [](const Image& image) {
    return *std::max_element(image.rgb.begin(), image.rgb.end());
  };
  const Image x_ray = scene.draw();
  scene.contents.at_eye = kStone;
  const Image dark = scene.draw();
  CHECK(brightest(x_ray) > 100);
  CHECK(brightest(dark) < 70);
  CHECK(brightest(dark) > 3);
  scene.contents.markers.push_back({27, 7, 16, 1, 1, 1, 255, 255, 255, false});
  CHECK(brightest(scene.draw()) == 255);
  scene.contents.markers.clear();
  // Under water, a near wall is tinted and a far one is hidden.
  scene.set_box({{0, 0, 0}, {64, 16, 32}}, kWater);
  scene.set_box({{0, 0, 0}, {64, 2, 32}}, kStone);
  scene.upload_all();
  scene.camera = {4.5, 6.5, 16.5};
  scene.contents.at_eye = kWater;
  const auto near = scene.colour_at(6.5, 2, 16.5);
  const auto far = scene.colour_at(60.5, 2, 16.5);
  CHECK(near[2] > near[0] + 15);
  CHECK(far[2] > far[0] + 30);
  scene.contents.at_eye = kAir;
  const auto dry = scene.colour_at(6.5, 2, 16.5);
  CHECK(dry[2] - dry[0] < near[2] - near[0]);
}

TEST_CASE(
    "of two panes of glass that stand across each other the front one decides, from all sides",
    "[render]") {
  const auto context = scene_context(&make_egl_surfaceless_context);
  if (!context) return;
  LitScene scene(*context);
  scene.contents.look.quality = GENERATE(Quality::low, Quality::medium, Quality::high);
  // A red pane along z and a blue one along x make a cross, with water behind and a floor below.
  scene.set_box({{2, 0, 2}, {30, 1, 30}}, kStone);
  scene.set_box({{10, 4, 2}, {11, 12, 22}}, kRedGlass);
  scene.set_box({{2, 4, 10}, {10, 12, 11}}, kBlueGlass);
  scene.set_box({{11, 4, 10}, {22, 12, 11}}, kBlueGlass);
  scene.set_box({{2, 1, 24}, {30, 3, 30}}, kWater);
  scene.upload_all();
  // Each sight passes both panes, beside the middle of the cross.
  const auto along = [&](double x, double z, double dx, double dz) {
    scene.camera.x = x, scene.camera.y = 8, scene.camera.z = z;
    return scene.colour_at(x + dx, 8, z + dz);
  };
  for (const double side : {-1.0, 1.0}) {
    // Seen from -x and +z, and from +x and -z.
    constexpr double kMiddle = 10.5;
    const auto red_first = along(kMiddle + side * 6.5, kMiddle - side * 3.5, -side * 3, side * 1);
    const auto blue_first = along(kMiddle + side * 3.5, kMiddle - side * 4.5, -side * 1, side * 2);
    CAPTURE(side, red_first[0], red_first[2], blue_first[0], blue_first[2]);
    CHECK(red_first[0] > blue_first[0] + 10);
    CHECK(blue_first[2] > red_first[2] + 10);
  }
}

}  // namespace runstone
