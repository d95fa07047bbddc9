// QuadShape: the axes of the quads of one direction: the axis along their strips and the axis along
// their rows. It turns a rectangle of faces into packed bits with shifts alone, in two steps: a
// strip opens in its first row and closes behind its last row.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/mesh/quad.hpp"

namespace runstone::rdm {

/// A strip of `length` faces from `begin` in one row of a layer.
struct Strip {
  std::uint32_t layer, begin, length, row;
};

/// Marks a quad of the transparent pass while it is open. The bit is zero in a closed quad.
/// Flipping the highest bit is an addition of 2^63 modulo 2^64, so it commutes with the addition in
/// QuadShape::close(), whatever the open quad has borrowed: a marked quad that is closed is the
/// closed quad with this bit set.
inline constexpr std::uint64_t kTransparentQuad = std::uint64_t{1} << 63;

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

  /// Returns the quad of a strip whose last row is not known yet. Its number of rows is negative
  /// and borrows from the bits above, so no field of it may be read before close(). close() adds
  /// `row_end` modulo 2^64, which repays the borrow exactly.
  constexpr Quad open(const Strip& s, Material material) const {
    return {(base_ | std::uint64_t{s.layer} << layer_shift_ |
             std::uint64_t{s.begin} << strip_shift_ | std::uint64_t{s.row} << row_shift_ |
             std::uint64_t{s.length - 1} << length_shift_ | std::uint64_t{material} << 38) -
            (std::uint64_t{s.row + 1} << rows_shift_)};
  }
  /// Returns the quad of the same strip in all rows before `row_end`.
  constexpr Quad close(Quad open, std::uint32_t row_end) const {
    return {open.bits + (std::uint64_t{row_end} << rows_shift_)};
  }

  /// Returns the open quad of a closed one: close() with the same row end reverses it.
  constexpr Quad reopen(Quad closed) const {
    return {closed.bits - (std::uint64_t{row_end(closed)} << rows_shift_)};
  }

  /// Returns a closed quad with one more row.
  constexpr Quad with_row_more(Quad q) const {
    return {q.bits + (std::uint64_t{1} << rows_shift_)};
  }

  /// Returns the first row of a closed quad; rows() returns the number of its rows.
  constexpr std::uint32_t row(Quad q) const {
    return static_cast<std::uint32_t>(q.bits >> row_shift_ & 127);
  }
  constexpr std::uint32_t rows(Quad q) const {
    return static_cast<std::uint32_t>(q.bits >> rows_shift_ & 127) + 1;
  }
  constexpr std::uint32_t row_end(Quad q) const { return row(q) + rows(q); }
  /// Returns the part of a closed quad in row `row`, with the strip from `first` to its last face.
  constexpr Quad piece(Quad q, std::uint32_t first, std::uint32_t row) const {
    const std::uint32_t length = last(q) + 1 - first;
    return {(q.bits & ~(kField << strip_shift_ | kField << length_shift_ | kField << row_shift_ |
                        kField << rows_shift_)) |
            std::uint64_t{first} << strip_shift_ | std::uint64_t{length - 1} << length_shift_ |
            std::uint64_t{row} << row_shift_};
  }
  /// Returns true if two closed quads are of equal strips, and `below` begins where `above` ends.
  constexpr bool joins(Quad above, Quad below) const {
    constexpr auto strip = [](Quad q, unsigned row_shift, unsigned rows_shift) {
      return q.bits & ~(kField << row_shift | kField << rows_shift);
    };
    return row_end(above) == row(below) &&
           strip(above, row_shift_, rows_shift_) == strip(below, row_shift_, rows_shift_);
  }
  /// Returns the first face along the strip; last() returns the last one.
  constexpr std::uint32_t first(Quad q) const {
    return static_cast<std::uint32_t>(q.bits >> strip_shift_ & 127);
  }
  constexpr std::uint32_t last(Quad q) const {
    return static_cast<std::uint32_t>((q.bits >> strip_shift_ & 127) +
                                      (q.bits >> length_shift_ & 127));
  }

 private:
  static constexpr std::uint64_t kField = 127;

  std::uint64_t base_ = 0;
  unsigned layer_shift_ = 0, strip_shift_ = 0, row_shift_ = 0, length_shift_ = 0, rows_shift_ = 0;
};

}  // namespace runstone::rdm
