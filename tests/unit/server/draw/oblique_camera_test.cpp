#include "server/draw/oblique_camera.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

namespace runstone {
namespace {

using Vec = std::array<double, 3>;

Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec unit(const Vec& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// The place of a point in the picture, -1 .. 1 each way, and its depth. The camera is that of the
/// renderer: forward from yaw and pitch, y up.
Vec seen_at(const DrawCamera& c, PictureSize size, const Vec& point) {
  const Vec forward{std::sin(c.yaw) * std::cos(c.pitch), std::sin(c.pitch),
                    std::cos(c.yaw) * std::cos(c.pitch)};
  const Vec right = unit(cross(forward, {0, 1, 0}));
  const Vec up = cross(right, forward);
  const Vec to{point[0] - c.x, point[1] - c.y, point[2] - c.z};
  const double depth = dot(to, forward), slope = std::tan(c.fov_y / 2);
  return {dot(to, right) / (depth * slope * size.width / size.height),
          dot(to, up) / (depth * slope), depth};
}

std::vector<Vec> corners(const VoxelBox& box) {
  std::vector<Vec> out;
  for (const double x : {box.min.x, box.max.x}) {
    for (const double y : {box.min.y, box.max.y}) {
      for (const double z : {box.min.z, box.max.z}) out.push_back({x, y, z});
    }
  }
  return out;
}

}  // namespace

TEST_CASE("an oblique camera sees the whole box with no more than the margin around it",
          "[server]") {
  const VoxelBox box =
      GENERATE(VoxelBox{{0, 0, 0}, {32, 32, 32}}, VoxelBox{{-500, -20, 300}, {400, 60, 340}},
               VoxelBox{{-3, -4000, -3}, {20, 100, 20}},
               VoxelBox{{(1 << 29) - 100, 0, -(1 << 29)}, {1 << 29, 50, 40 - (1 << 29)}});
  const PictureSize size = GENERATE(PictureSize{1280, 720}, PictureSize{100, 300});
  const ViewDirection direction =
      GENERATE(ViewDirection{}, ViewDirection{-2.5, -0.2}, ViewDirection{4, 0.9});
  const DrawCamera camera = oblique_camera(box, size, direction);
  CAPTURE(box.min.x, box.max.x, size.width, direction.yaw, camera.x, camera.y, camera.z);
  CHECK(validate(DrawPicture{camera, size, "a.png"}).has_value());
  std::array<double, 2> low{2, 2}, high{-2, -2};
  for (const Vec& corner : corners(box)) {
    const Vec at = seen_at(camera, size, corner);
    CHECK(at[2] > camera.near);
    CHECK(at[2] < 0.6 * camera.far + 1);  // the fog begins there
    for (std::size_t i = 0; i < 2; ++i) {
      low[i] = std::min(low[i], at[i]);
      high[i] = std::max(high[i], at[i]);
    }
  }
  const auto touches = [&](std::size_t i) {
    return low[i] == Approx(-0.94).margin(1e-4) && high[i] == Approx(0.94).margin(1e-4);
  };
  CHECK((touches(0) || touches(1)));
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(low[i] > -0.9401);
    CHECK(high[i] < 0.9401);
  }
}

TEST_CASE("one voxel is seen in its surroundings", "[server]") {
  const VoxelBox voxel{{10, 20, 30}, {11, 21, 31}}, around{{3, 13, 23}, {18, 28, 38}};
  const PictureSize size{640, 360};
  const DrawCamera camera = oblique_camera(voxel, size);
  for (const Vec& corner : corners(around)) {
    const Vec at = seen_at(camera, size, corner);
    CHECK(std::abs(at[0]) < 1);
    CHECK(std::abs(at[1]) < 1);
  }
  const Vec middle = seen_at(camera, size, {10.5, 20.5, 30.5});
  CHECK(std::abs(middle[0]) < 0.25);
  CHECK(std::abs(middle[1]) < 0.25);
}

}  // namespace runstone
