// Rivers run downhill, and every square knows the same ones.
#include "common/generate/landscape/drainage.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <tuple>

using namespace runstone;

namespace {

/// A watercourse in voxels of the world, so that those of two squares compare.
auto in_world(const Watercourse& course, std::int32_t square_x, std::int32_t square_z) {
  return std::tuple(course.x + std::int64_t{square_x} * kDrainageWidth * 16,
                    course.z + std::int64_t{square_z} * kDrainageWidth * 16, course.to_x,
                    course.to_z, course.level, course.to_level, course.half_width,
                    course.to_half_width, course.is_wet, course.is_lake);
}

/// Returns the watercourses of the nodes in a square itself. The node of square (x, z) lies in it.
auto starting_in(const Drainage& drainage, std::int32_t asking_x, std::int32_t asking_z,
                 std::int32_t x, std::int32_t z) {
  std::vector<decltype(in_world({}, 0, 0))> out;
  const std::int32_t low_x = (x - asking_x) * kDrainageWidth * 16;
  const std::int32_t low_z = (z - asking_z) * kDrainageWidth * 16;
  for (const Watercourse& course : *drainage.square(asking_x, asking_z)) {
    if (course.x >= low_x && course.x < low_x + kDrainageWidth * 16 && course.z >= low_z &&
        course.z < low_z + kDrainageWidth * 16)
      out.push_back(in_world(course, asking_x, asking_z));
  }
  return out;
}

}  // namespace

TEST_CASE("rivers run downhill and get no narrower", "[generate][landscape]") {
  int rivers = 0, lakes = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Drainage drainage(seed);
    for (std::int32_t x = -8; x < 8; x += 3) {
      for (std::int32_t z = -8; z < 8; z += 3) {
        for (const Watercourse& course : *drainage.square(x, z)) {
          CHECK(course.level >= course.to_level);
          if (!course.is_lake) CHECK(course.to_half_width >= course.half_width);
          if (!course.is_wet) continue;
          lakes += course.is_lake ? 1 : 0;
          rivers += course.is_lake ? 0 : 1;
          CHECK(course.half_width > 0);
          CHECK(course.level > 0);
        }
      }
    }
  }
  CHECK(rivers > 100);
  CHECK(lakes > 20);
}

TEST_CASE("the square that asks changes no watercourse", "[generate][landscape]") {
  const Drainage drainage(7);
  std::size_t found = 0;
  for (const std::int32_t far : {0, 500'000, -500'000}) {
    for (std::int32_t x = far - 3; x < far + 3; ++x) {
      for (std::int32_t z = -3; z < 3; ++z) {
        const auto expected = starting_in(drainage, x, z, x, z);
        found += expected.size();
        CHECK(expected == starting_in(drainage, x + 2, z, x, z));
        CHECK(expected == starting_in(drainage, x - 1, z - 2, x, z));
        CHECK(expected == starting_in(Drainage(7), x + 1, z - 1, x, z));
      }
    }
  }
  CHECK(found > 50);
}

TEST_CASE("a point of a river is as far as its nearest point, and levels fall along it",
          "[generate][landscape]") {
  // From (0, 0) to (1600, 0), 100 voxels, from level 20 to level 10, half of the way at 20.
  const std::int64_t squared = 1600 * 1600;
  const Watercourse course{0,  0,    0 + 1600, 0,        (std::int64_t{1} << 44) / squared,
                           20, 10,   kOne / 2, 2 * kOne, 32,
                           64, true, false};
  const auto near = nearest_point(course, 400, 300);
  CHECK(near.distance_squared == Approx(300 * 300).margin(400));
  CHECK(near.level == 20 * 256);
  CHECK(nearest_point(course, 1600, 0).level == Approx(10 * 256).margin(8));
  CHECK(nearest_point(course, 1200, 0).level == Approx(15 * 256).margin(8));
  CHECK(nearest_point(course, 5000, 0).half_width == 64);
  CHECK(nearest_point(course, -30, 40).distance_squared == 2500);
  const Watercourse lake{160, 160, 0, 0, 0, 9, 9, 0, 0, 800, 800, true, true};
  CHECK(nearest_point(lake, 160, 460).distance_squared == 90000);
  CHECK(nearest_point(lake, 160, 460).level == 9 * 256);
}
