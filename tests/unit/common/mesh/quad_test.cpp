#include "common/mesh/quad.hpp"

#include <catch2/catch.hpp>

#include "common/mesh/quad_corners.hpp"

namespace runstone {
namespace {

TEST_CASE("a quad packs to its documented bits", "[mesh]") {
  CHECK(pack({0, 0, 0, 1, 1, Direction::neg_x, 0}).bits == 0);
  CHECK(pack({1, 2, 3, 4, 5, Direction::pos_y, 6}).bits == 0x0000'0198'4060'c101ULL);
  CHECK(pack({127, 127, 127, 128, 128, Direction::pos_z, 65535}).bits == 0x003f'ffef'ffff'ffffULL);
  CHECK(pack({127, 0, 0, 1, 1, Direction::neg_x, 0}).bits == 0x7fULL);
  CHECK(pack({0, 127, 0, 1, 1, Direction::neg_x, 0}).bits == 0x7fULL << 7);
  CHECK(pack({0, 0, 127, 1, 1, Direction::neg_x, 0}).bits == 0x7fULL << 14);
  CHECK(pack({0, 0, 0, 128, 1, Direction::neg_x, 0}).bits == 0x7fULL << 21);
  CHECK(pack({0, 0, 0, 1, 128, Direction::neg_x, 0}).bits == 0x7fULL << 28);
  CHECK(pack({0, 0, 0, 1, 1, Direction::pos_z, 0}).bits == 5ULL << 35);
  CHECK(pack({0, 0, 0, 1, 1, Direction::neg_x, 0xabcd}).bits == 0xabcdULL << 38);
}

TEST_CASE("unpack gives back every field", "[mesh]") {
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    for (const std::uint8_t at : std::array<std::uint8_t, 4>{0, 1, 64, 127}) {
      for (const std::uint8_t size : std::array<std::uint8_t, 4>{1, 2, 127, 128}) {
        const auto other = static_cast<std::uint8_t>(127 - at);
        const auto other_size = static_cast<std::uint8_t>(129 - size);
        const QuadFields q = {at,
                              other,
                              at,
                              size,
                              other_size,
                              static_cast<Direction>(d),
                              static_cast<Material>(at * 511)};
        CHECK(unpack(pack(q)) == q);
      }
    }
  }
}

TEST_CASE("the width of a quad runs along u and the height along v, cyclically after its axis",
          "[mesh]") {
  CHECK(u_axis_of(Axis::x) == Axis::y);
  CHECK(v_axis_of(Axis::x) == Axis::z);
  CHECK(u_axis_of(Axis::y) == Axis::z);
  CHECK(v_axis_of(Axis::y) == Axis::x);
  CHECK(u_axis_of(Axis::z) == Axis::x);
  CHECK(v_axis_of(Axis::z) == Axis::y);
}

TEST_CASE("corners of a quad are at the ends of its voxels", "[mesh]") {
  const std::array<Corner, 4> top =
      quad_corners(pack({2, 7, 4, 3, 5, Direction::pos_y, 1}));  // u is z, v is x
  CHECK(top == std::array<Corner, 4>{{{2, 8, 4}, {2, 8, 7}, {7, 8, 7}, {7, 8, 4}}});
  const std::array<Corner, 4> bottom = quad_corners(pack({2, 7, 4, 3, 5, Direction::neg_y, 1}));
  CHECK(bottom == std::array<Corner, 4>{{{2, 7, 4}, {7, 7, 4}, {7, 7, 7}, {2, 7, 7}}});
  const std::array<Corner, 4> far_side =
      quad_corners(pack({127, 0, 0, 128, 128, Direction::pos_x, 1}));
  CHECK(far_side ==
        std::array<Corner, 4>{{{128, 0, 0}, {128, 128, 0}, {128, 128, 128}, {128, 0, 128}}});
}

TEST_CASE("corners wind counter-clockwise seen from outside in every direction", "[mesh]") {
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    const auto direction = static_cast<Direction>(d);
    const auto c = quad_corners(pack({5, 6, 7, 2, 3, direction, 1}));
    Corner first{};
    Corner second{};
    for (std::size_t i = 0; i < 3; ++i) {
      first[i] = c[1][i] - c[0][i];
      second[i] = c[2][i] - c[1][i];
    }
    const Corner normal = {first[1] * second[2] - first[2] * second[1],
                           first[2] * second[0] - first[0] * second[2],
                           first[0] * second[1] - first[1] * second[0]};
    Corner expected{};
    expected[static_cast<std::size_t>(axis_of(direction))] =
        is_positive(direction) ? 6 : -6;  // 2 x 3 faces
    CAPTURE(d);
    CHECK(normal == expected);
    for (std::size_t i = 0; i < 3; ++i)
      CHECK(c[0][i] + c[2][i] == c[1][i] + c[3][i]);  // a parallelogram
  }
}

static_assert(unpack(pack({9, 8, 7, 6, 5, Direction::neg_z, 4})) ==
              QuadFields{9, 8, 7, 6, 5, Direction::neg_z, 4});

}  // namespace
}  // namespace runstone
