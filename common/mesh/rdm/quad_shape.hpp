// QuadShape: how the quads of one direction lie: which axis their strips run along, which axis their rows go
// up. Turns a rectangle of faces into packed bits with shifts alone, in two steps: a strip opens when
// it is first met and closes behind its last row.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::rdm {

/// A strip of `length` faces from `begin` in one row of a layer.
struct Strip {
  std::uint32_t layer, begin, length, row;
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

  /// The quad of a strip whose last row is not known yet; close() adds it.
  constexpr Quad open(const Strip& s, Material material) const {
    return {(base_ | std::uint64_t{s.layer} << layer_shift_ | std::uint64_t{s.begin} << strip_shift_ |
             std::uint64_t{s.row} << row_shift_ | std::uint64_t{s.length - 1} << length_shift_ |
             std::uint64_t{material} << 38) -
            (std::uint64_t{s.row + 1} << rows_shift_)};
  }
  /// The same strip in all rows before `row_end`.
  constexpr Quad close(Quad open, std::uint32_t row_end) const {
    return {open.bits + (std::uint64_t{row_end} << rows_shift_)};
  }

 private:
  std::uint64_t base_ = 0;
  unsigned layer_shift_ = 0, strip_shift_ = 0, row_shift_ = 0, length_shift_ = 0, rows_shift_ = 0;
};

}  // namespace runstone::rdm
