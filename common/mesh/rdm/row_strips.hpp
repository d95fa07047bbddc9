// Row strips: the faces of one row as strips, and the differences between two rows. Every path of
// the mesher joins faces by this one rule: strips are as long as possible, and continue while the
// next row repeats them exactly. Internal to rdm.
#pragma once
#include "common/runs/bit_row.hpp"

namespace runstone::rdm {

/// The faces of a row, and the first and last of each strip.
template <class Row>
struct RowStrips {
  Row face = 0, start = 0, end = 0;
};

/// Returns the strips along the bits of a row. `cut` marks the bits whose material differs from the
/// bit below.
template <class Row>
constexpr RowStrips<Row> strips_along(Row face, Row cut) {
  return {face, face & (~(face << 1) | cut), face & (~(face >> 1) | (cut >> 1))};
}

/// Returns the bits of strips in which two rows differ. `cut` marks the bits whose material differs
/// between the rows.
template <class Row>
constexpr Row changed(const RowStrips<Row>& now, const RowStrips<Row>& before, Row cut) {
  return (now.face ^ before.face) | (now.start ^ before.start) | (now.end ^ before.end) |
         (now.face & before.face & cut);
}

/// Returns the ends of the strips with a changed bit. A carry runs from the lowest changed bit of a
/// strip to its end: all other bits of a strip are ones, and the end itself is left out.
template <class Row>
constexpr Row ends_with(const RowStrips<Row>& strips, Row x) {
  x &= strips.face;
  const Row inner = strips.face & ~strips.end;
  return strips.end & (x | (inner + (x & inner)));
}

}  // namespace runstone::rdm
