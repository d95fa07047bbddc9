// Stars, moon and clouds, and the colours of the night. The cases draw off screen. If there is no
// OpenGL context, they say so with WARN and pass.
#include <algorithm>
#include <cmath>

#include "client/render/day_light.hpp"
#include "tests/integration/client/render/different_pixels.hpp"
#include "tests/integration/client/render/ground_scene.hpp"

namespace runstone::test {
namespace {

constexpr double kMidnight = 0, kNoon = 0.5;

/// Counts pixels that are much brighter than those to the left and right of them.
int count_points(const Image& image) {
  const auto brightness = [&](int x, int y) {
    const std::size_t at = static_cast<std::size_t>(y * image.width + x) * 3;
    return image.rgb[at] + image.rgb[at + 1] + image.rgb[at + 2];
  };
  int out = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 2; x + 2 < image.width; ++x) {
      const int around = std::max(brightness(x - 2, y), brightness(x + 2, y));
      out += brightness(x, y) > around + 60 ? 1 : 0;
    }
  }
  return out;
}

void look_towards(Camera& camera, const glm::vec3& direction) {
  camera.yaw = std::atan2(double{direction.x}, double{direction.z});
  camera.pitch = std::asin(double{direction.y});
}

}  // namespace

TEST_CASE("there are stars at night, none at noon, and none below the ground", "[render]") {
  GroundScene scene(one_material({90, 140, 60, 255}, {0, 0, 100, 0}));
  if (!scene.draws()) return;
  scene.contents.look.quality = GENERATE(Quality::low, Quality::medium);
  scene.camera.yaw = 1.2;
  scene.camera.pitch = 0.9;
  scene.contents.look.time_of_day = kMidnight;
  CHECK(count_points(scene.draw()) > 15);
  scene.contents.look.time_of_day = kNoon;
  CHECK(count_points(scene.draw()) == 0);
  scene.set_floor(1);
  scene.contents.look.time_of_day = kMidnight;
  scene.camera.pitch = -M_PI / 2;
  CHECK(count_points(scene.draw()) == 0);
}

TEST_CASE("the moon is a disc with a dark rim, and the sun is white", "[render]") {
  GroundScene scene(one_material({90, 140, 60, 255}, {0, 0, 100, 0}));
  if (!scene.draws()) return;
  scene.contents.look.quality = Quality::low;  // no clouds before them
  scene.camera.fov_y = 0.2;
  for (const double time : {0.05, 0.4}) {
    CAPTURE(time);
    const DayLight light = day_light(time, 500);
    look_towards(scene.camera, light.sun_direction);
    scene.contents.look.time_of_day = time;
    const Image image = scene.draw();
    const auto middle = colour_of(image, 0.5, 0.5), corner = colour_of(image, 0.02, 0.02);
    CHECK(middle[1] > corner[1] + 40);
    CHECK(middle[1] > (light.is_moon ? 120 : 225));
    // The darkest pixel of the middle line within the disc of the moon is in its shadow.
    int darkest = 255;
    for (double u = 0.40; u < 0.60; u += 0.005)
      darkest = std::min(darkest, colour_of(image, u, 0.5)[1]);
    CHECK((middle[1] - darkest > 25) == light.is_moon);
  }
}

TEST_CASE("clouds cover a part of the sky and drift, but not at low quality", "[render]") {
  GroundScene scene(one_material({90, 140, 60, 255}, {0, 0, 100, 0}));
  if (!scene.draws()) return;
  scene.contents.look.time_of_day = kNoon;
  scene.camera.pitch = 0.5;
  scene.camera.yaw = 3;  // the sun is behind
  scene.camera.fov_y = 1.4;
  const auto picture = [&](Quality quality, double seconds) {
    scene.contents.look.quality = quality;
    scene.contents.look.seconds = seconds;
    return scene.draw();
  };
  const Image clear = picture(Quality::low, 0), cloudy = picture(Quality::medium, 0);
  const std::size_t pixels = clear.rgb.size() / 3;
  const std::size_t covered = different_pixels(clear, cloudy);
  CHECK(covered > pixels / 20);
  CHECK(covered < pixels * 9 / 10);
  CHECK(different_pixels(cloudy, picture(Quality::medium, 600)) > pixels / 50);
  CHECK(different_pixels(cloudy, picture(Quality::medium, 0)) == 0);
  CHECK(different_pixels(clear, picture(Quality::low, 600)) == 0);
}

TEST_CASE("ground loses its green at night", "[render]") {
  GroundScene scene(one_material({60, 160, 40, 255}, {0, 0, 100, 0}));
  if (!scene.draws()) return;
  scene.set_floor(1);
  scene.camera.pitch = -M_PI / 2;
  const auto green = [&](double time) {
    scene.contents.look.time_of_day = time;
    const auto c = mean_colour(scene.draw());
    return (c[1] - std::max(c[0], c[2])) / c[1];
  };
  const double by_day = green(kNoon), at_night = green(kMidnight);
  CAPTURE(by_day, at_night);
  CHECK(by_day > 0.25);
  CHECK(at_night < 0.4 * by_day);
}

}  // namespace runstone::test
