// The tint of natural ground by its place. The cases draw off screen. If there is no OpenGL
// context, they say so with WARN and pass.
#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/integration/client/render/ground_scene.hpp"

namespace runstone::test {
namespace {

/// Returns the share of red in the green of a floor, in chunks at some places.
std::vector<double> hues(GroundScene& scene, const MaterialLook& look) {
  scene.set_materials(one_material({110, 130, 70, 255}, look));
  std::vector<double> out;
  for (int place = 0; place < 8; ++place) {
    scene.move_to({7 * place - 30, 0, 5 * place - 20});
    const auto colour = mean_colour(scene.draw());
    out.push_back(colour[0] / colour[1]);
  }
  return out;
}

double spread(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax_element(values);
  return *most - *least;
}

}  // namespace

TEST_CASE("grass has another tint at another place, and planks have not", "[render]") {
  GroundScene scene(one_material({110, 130, 70, 255}, {}));
  if (!scene.draws()) return;
  scene.set_floor(1);
  scene.contents.look.quality = Quality::low;
  scene.camera.pitch = -M_PI / 2;
  const auto grass = hues(scene, {0, 26, 100, 0});
  CHECK(spread(grass) > 0.05);
  CHECK(hues(scene, {0, 26, 100, 0}) == grass);
  // Little grain, a pattern, or light of its own.
  CHECK(spread(hues(scene, {0, 8, 100, 0})) < 0.01);
  CHECK(spread(hues(scene, {0, 26, 75, 0, MaterialPattern::planks})) < 0.01);
  CHECK(spread(hues(scene, {0, 26, 100, 60})) < 0.01);
}

}  // namespace runstone::test
