// The glow around lamps. The cases draw off screen. If there is no OpenGL context, they say so with
// WARN and pass.
#include "tests/integration/client/render/different_pixels.hpp"
#include "tests/integration/client/render/ground_scene.hpp"

namespace runstone::test {
namespace {

constexpr Material kDull = 1, kGlowing = 2;

MaterialTable dull_and_glowing() {
  MaterialTable out = one_material({120, 120, 120, 255}, {0, 0, 100, 0});
  REQUIRE(out.add({"lamp",
                   {255, 220, 150, 255},
                   Visibility::opaque,
                   {},
                   MaterialBody::solid,
                   MaterialLook{0, 0, 100, 100}})
              .has_value());
  return out;
}

int brightness_beside_lamp(GroundScene& scene) {
  // The lamp is 10 voxels away, in the middle of the picture; the pixel is 1.2 voxels beside it.
  const auto c = colour_of(scene.draw(), 0.5 + 1.2 / 10 / (2 * 0.684 * 4 / 3), 0.5);
  return c[0] + c[1] + c[2];
}

}  // namespace

TEST_CASE("the air around a lamp glows at night, more than by day", "[render]") {
  GroundScene scene(dull_and_glowing());
  if (!scene.draws()) return;
  scene.contents.look.antialiasing = GENERATE(Antialiasing::off, Antialiasing::msaa);
  scene.contents.look.time_of_day = 0;
  scene.camera.x = 16.5;
  scene.camera.y = 20.5;
  scene.camera.z = 6.5;
  scene.camera.pitch = 0;
  const VoxelBox place{{16, 20, 16}, {17, 21, 17}};
  scene.set(place, kDull);
  const int dark = brightness_beside_lamp(scene);
  scene.set(place, kGlowing);
  const int night = brightness_beside_lamp(scene);
  CHECK(night > dark + 60);
  // At low quality lamps light nothing.
  scene.contents.look.quality = Quality::low;
  CHECK(brightness_beside_lamp(scene) <= dark + 30);
  scene.contents.look.quality = Quality::medium;
  scene.contents.look.time_of_day = 0.5;
  const int day = brightness_beside_lamp(scene);
  scene.set(place, kDull);
  CHECK(day - brightness_beside_lamp(scene) < night - dark);
}

TEST_CASE("a wall hides the glow of a lamp behind it", "[render]") {
  GroundScene scene(dull_and_glowing());
  if (!scene.draws()) return;
  scene.contents.look.time_of_day = 0;
  scene.camera.x = 16.5;
  scene.camera.y = 20.5;
  scene.camera.z = 2.5;
  scene.camera.pitch = 0;
  scene.set({{4, 8, 10}, {29, 32, 11}}, kDull);
  const Image without = scene.draw();
  scene.set({{16, 20, 20}, {17, 21, 21}}, kGlowing);
  CHECK(different_pixels(without, scene.draw()) == 0);
}

}  // namespace runstone::test
