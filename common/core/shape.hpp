// Shape: the form of a voxel that is not a cube, such as a slab, stairs, a pane or a plant. It is a
// property of the material: voxels, runs, edits and digests do not depend on it. All values are
// integers, so that tables, records and messages hold the same values.
#pragma once
#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// The units of a shape along each side of a voxel: a sixteenth of a voxel.
inline constexpr std::uint8_t kShapeUnits = 16;

/// A box inside a voxel, in sixteenths from the voxel's smallest corner, along x, y and z.
struct ShapeBox {
  std::array<std::uint8_t, 3> min{0, 0, 0};                                // 0 .. 15
  std::array<std::uint8_t, 3> max{kShapeUnits, kShapeUnits, kShapeUnits};  // min + 1 .. 16
  friend bool operator==(const ShapeBox&, const ShapeBox&) = default;
  friend std::strong_ordering operator<=>(const ShapeBox&, const ShapeBox&) = default;
};

/// Values are frozen: tables, records and messages hold them.
enum class ShapeForm : std::uint8_t {
  boxes = 0,    // the union of the boxes
  crossed = 1,  // the two upright diagonal planes of each box, seen from both sides: a plant
};

struct Shape {
  ShapeForm form = ShapeForm::boxes;
  std::vector<ShapeBox> boxes;  // at most kShapeBoxesMax; none: the material is a cube
  bool is_cube() const { return boxes.empty(); }
  friend bool operator==(const Shape&, const Shape&) = default;
  friend std::strong_ordering operator<=>(const Shape&, const Shape&) = default;
};

/// The order of shapes that are held by address.
struct ShapeBefore {
  bool operator()(const Shape* a, const Shape* b) const { return *a < *b; }
};

/// The boxes of one shape, at most. Built-in kinds have fewer than half of them.
inline constexpr std::size_t kShapeBoxesMax = 32;

/// The different shapes of the materials of one world, at most. The bound keeps Welcome within its
/// class, and numbers of shapes within 16 bits.
inline constexpr std::size_t kTableShapesMax = 4096;

/// Fails (bad_value) for an unknown form, a cube with the form `crossed`, or a box that is empty or
/// leaves the voxel, and (limit_exceeded) for more than kShapeBoxesMax boxes. The offset of the
/// error is the number of the box. Cost: O(boxes).
Result<void> validate_shape(const Shape& shape);

}  // namespace runstone
