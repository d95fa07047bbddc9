// The faces of random boxes are compared with an oracle that asks every cell for its six sides.
#include "common/shapes/shape_faces.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>
#include <tuple>

#include "common/core/hash.hpp"

namespace runstone::test {
namespace {

constexpr int kSide = kShapeUnits;

/// A side of a cell: its direction and the cell's place.
using CellSide = std::tuple<Direction, int, int, int>;

Shape random_shape(SplitMix64& rng) {
  Shape out;
  const std::uint32_t count = 1 + rng.below(rng.below(4) == 0 ? 32 : 5);
  for (std::uint32_t i = 0; i < count; ++i) {
    ShapeBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t low = rng.below(16);
      box.min[axis] = static_cast<std::uint8_t>(low);
      box.max[axis] = static_cast<std::uint8_t>(low + 1 + rng.below(16 - low));
    }
    out.boxes.push_back(box);
  }
  return out;
}

bool is_filled(const Shape& shape, int x, int y, int z) {
  return std::any_of(shape.boxes.begin(), shape.boxes.end(), [&](const ShapeBox& box) {
    return x >= box.min[0] && x < box.max[0] && y >= box.min[1] && y < box.max[1] &&
           z >= box.min[2] && z < box.max[2];
  });
}

std::array<int, 3> step_of(Direction d) {
  std::array<int, 3> out{};
  out[static_cast<std::size_t>(axis_of(d))] = is_positive(d) ? 1 : -1;
  return out;
}

std::set<CellSide> exposed_sides(const Shape& shape) {
  std::set<CellSide> out;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      for (int z = 0; z < kSide; ++z) {
        if (!is_filled(shape, x, y, z)) continue;
        for (int d = 0; d < kDirectionCount; ++d) {
          const auto step = step_of(static_cast<Direction>(d));
          if (!is_filled(shape, x + step[0], y + step[1], z + step[2]))
            out.emplace(static_cast<Direction>(d), x, y, z);
        }
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("faces cover each exposed side of a cell once and nothing else", "[shapes][property]") {
  SplitMix64 rng(Catch::rngSeed());
  for (int step = 0; step < 150; ++step) {
    const Shape shape = random_shape(rng);
    REQUIRE(validate_shape(shape));
    CAPTURE(Catch::rngSeed(), step);
    const ShapeFaces faces(shape);
    const auto exposed = exposed_sides(shape);
    std::set<CellSide> covered;
    bool is_once = true;
    for (const ShapeFace& face : faces.faces()) {
      REQUIRE(face.is_flat());
      const auto w = static_cast<std::size_t>(axis_of(face.direction));
      std::array<int, 3> cell{};
      cell[w] = face.depth - (is_positive(face.direction) ? 1 : 0);
      for (int v = face.v0; v < face.v1; ++v) {
        for (int u = face.u0; u < face.u1; ++u) {
          cell[(w + 1) % 3] = u;
          cell[(w + 2) % 3] = v;
          is_once &= covered.emplace(face.direction, cell[0], cell[1], cell[2]).second;
        }
      }
    }
    CHECK(is_once);
    CHECK(covered == exposed);
    CHECK(std::is_sorted(
        faces.faces().begin(), faces.faces().end(),
        [](const ShapeFace& a, const ShapeFace& b) { return a.direction < b.direction; }));

    unsigned volume = 0;
    bool sides_agree = true;
    for (int x = 0; x < kSide; ++x) {
      for (int y = 0; y < kSide; ++y) {
        for (int z = 0; z < kSide; ++z) volume += is_filled(shape, x, y, z) ? 1 : 0;
        const auto bit = [](int u, int v) { return static_cast<std::size_t>(v * kSide + u); };
        // (u, v) are (y, z), (z, x) and (x, y).
        sides_agree &= faces.side(Direction::neg_x)[bit(x, y)] == is_filled(shape, 0, x, y);
        sides_agree &= faces.side(Direction::pos_x)[bit(x, y)] == is_filled(shape, 15, x, y);
        sides_agree &= faces.side(Direction::neg_y)[bit(x, y)] == is_filled(shape, y, 0, x);
        sides_agree &= faces.side(Direction::pos_y)[bit(x, y)] == is_filled(shape, y, 15, x);
        sides_agree &= faces.side(Direction::neg_z)[bit(x, y)] == is_filled(shape, x, y, 0);
        sides_agree &= faces.side(Direction::pos_z)[bit(x, y)] == is_filled(shape, x, y, 15);
      }
    }
    CHECK(filled_cells(shape) == volume);
    CHECK(sides_agree);
  }
}

}  // namespace runstone::test
