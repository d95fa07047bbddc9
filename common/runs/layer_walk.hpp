// The layer walk visits one layer of a chunk stretch by stretch, with one forward cursor. The layer
// may lie across any axis. An axis is named by its rank in the chunk's order: 0 fastest, 1 middle,
// 2 slowest.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/runs/axis_order.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {

/// Calls stretch(slow, first, last, material) for stretches of one material that tile the layer in
/// index order. Of the two other axes, `slow` is the coordinate along the slower one, and [first,
/// last) lies along the faster one. Requires at < side(rank). Cost: O(rows + runs that touch the
/// layer), plus a galloping seek per row for ranks 0 and 1.
template <class Runs, class F>
void walk_layer(Runs runs, OrderedExtent e, int rank, std::uint32_t at, F&& stretch) {
  RunCursor<Runs> cursor(runs);
  if (rank == 2) {  // the layer is one stretch of the index order
    cursor.seek(at * e.layer());
    for (std::uint32_t m = 0; m < e.m; ++m) {
      const std::uint32_t line = at * e.layer() + m * e.f;
      for (std::uint32_t f = 0; f < e.f;) {
        if (cursor.end() == line + f) cursor.next();
        const std::uint32_t last = std::min(cursor.end() - line, e.f);
        stretch(m, f, last, cursor.material());
        f = last;
      }
    }
    return;
  }
  if (rank == 1) {  // the layer has one line of each slow layer
    for (std::uint32_t s = 0; s < e.s; ++s) {
      const std::uint32_t line = s * e.layer() + at * e.f;
      cursor.seek(line);
      for (std::uint32_t f = 0; f < e.f;) {
        if (cursor.end() == line + f) cursor.next();
        const std::uint32_t last = std::min(cursor.end() - line, e.f);
        stretch(s, f, last, cursor.material());
        f = last;
      }
    }
    return;
  }
  // The layer has one voxel of every line. A long run covers many lines at once.
  for (std::uint32_t s = 0; s < e.s; ++s) {
    const std::uint32_t base = s * e.layer() + at;
    for (std::uint32_t m = 0; m < e.m;) {
      const std::uint32_t voxel = base + m * e.f;
      if (cursor.end() <= voxel) cursor.seek(voxel);
      const std::uint32_t covered = (cursor.end() - voxel + e.f - 1) / e.f;
      const std::uint32_t last = std::min(m + covered, e.m);
      stretch(s, m, last, cursor.material());
      m = last;
    }
  }
}

/// Returns the rank of an axis in an order.
constexpr int rank_of(Axis axis, AxisOrder order) {
  const auto axes = axes_of(order);
  return axes[0] == axis ? 0 : axes[1] == axis ? 1 : 2;
}

}  // namespace runstone
