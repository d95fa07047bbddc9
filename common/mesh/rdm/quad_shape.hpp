// QuadShape: how the quads of one direction lie: which axis their strips run along, which axis their rows go
// up. Turns a rectangle of faces into packed bits with shifts alone.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::rdm {

/// A rectangle of faces in one layer: strips of `length` faces from `begin`, repeated in `rows` rows from
/// `row`.
struct Rectangle {
  std::uint32_t layer, begin, length, row, rows;
};

class QuadShape {
 public:
  constexpr QuadShape() = default;
  /// Requires three different axes: that of the direction, `strip` and `row`.
  constexpr QuadShape(Direction direction, Axis strip, Axis row)
      : base_(static_cast<std::uint64_t>(direction) << 35),
        layer_shift_(7 * static_cast<unsigned>(axis_of(direction))),
        strip_shift_(7 * static_cast<unsigned>(strip)),
        row_shift_(7 * static_cast<unsigned>(row)),
        length_shift_(u_axis_of(axis_of(direction)) == strip ? 21 : 28),
        rows_shift_(u_axis_of(axis_of(direction)) == strip ? 28 : 21) {}

  constexpr Quad quad(const Rectangle& r, Material material) const {
    return {base_ | std::uint64_t{r.layer} << layer_shift_ | std::uint64_t{r.begin} << strip_shift_ |
            std::uint64_t{r.row} << row_shift_ | std::uint64_t{r.length - 1} << length_shift_ |
            std::uint64_t{r.rows - 1} << rows_shift_ | std::uint64_t{material} << 38};
  }

 private:
  std::uint64_t base_ = 0;
  unsigned layer_shift_ = 0, strip_shift_ = 0, row_shift_ = 0, length_shift_ = 0, rows_shift_ = 0;
};

}  // namespace runstone::rdm
