// ShapeFaces: the surface of a shape as rectangles, in the form that the mesher and the GPU use.
#pragma once
#include <array>
#include <bitset>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/core/shape.hpp"

namespace runstone {

/// A rectangle of the surface of a shape inside a voxel, in sixteenths from the voxel's smallest
/// corner. u and v are the axes of a quad of that direction (common/mesh/quad.hpp).
struct ShapeFace {
  Direction direction = Direction::neg_x;  // from which it is seen
  /// The place along the axis of the direction, 0 .. 16: at v0 and at v1. They differ for the
  /// planes of plants alone, whose axis is x, so that v runs along z.
  std::uint8_t depth = 0, far_depth = 0;
  std::uint8_t u0 = 0, u1 = kShapeUnits, v0 = 0, v1 = kShapeUnits;  // u0 < u1, v0 < v1
  bool is_flat() const { return depth == far_depth; }
  friend auto operator<=>(const ShapeFace&, const ShapeFace&) = default;
};

/// The cells of one side of a voxel that a shape fills: bit v * 16 + u.
using SideMask = std::bitset<std::size_t{kShapeUnits} * kShapeUnits>;

class ShapeFaces {
 public:
  /// Requires a valid shape that is no cube. The rectangles of boxes cover the surface of their
  /// union exactly once: what lies between two boxes that touch or overlap is no surface. They
  /// ascend by direction, and their order is deterministic. Cost: some 10 microseconds.
  explicit ShapeFaces(const Shape& shape);

  std::span<const ShapeFace> faces() const { return faces_; }
  /// Returns the cells of the voxel's side in this direction that the shape fills. Crossed planes
  /// fill none.
  const SideMask& side(Direction d) const { return sides_[static_cast<std::size_t>(d)]; }

 private:
  std::vector<ShapeFace> faces_;
  std::array<SideMask, kDirectionCount> sides_;
};

/// Returns the volume that a shape fills, in cells, 0 .. 4096. Crossed planes fill none. Requires a
/// valid shape that is no cube. Cost: O(boxes).
unsigned filled_cells(const Shape& shape);

/// A shape of more faces is not accepted: a quad has ten bits for the number of the face
/// (common/mesh/quad.hpp).
inline constexpr std::size_t kShapeFacesMax = 1023;

/// Returns success for a shape that a material may have. Fails as validate_shape() does, with
/// bad_value for a cube, and with limit_exceeded for more than kShapeFacesMax faces. Shapes from
/// outside pass through here. Cost: that of ShapeFaces.
Result<void> check_shape(const Shape& shape);

/// Returns true if the face lies on the border of the voxel that its direction names.
bool is_on_border(const ShapeFace& face);

}  // namespace runstone
