// Span boxes: a stretch of a flattened chunk as boxes, in order: part of a line, whole lines, whole
// layers, whole lines, part of a line. So there are at most five (thesis 7.3), and fewer if the
// stretch begins or ends with a line or layer.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// A half-open, non-empty box along the fastest, middle and slowest axis.
struct OrderedBox {
  std::array<std::uint32_t, 3> first{}, last{};
};

/// Calls f(box) for the boxes of voxels [first, last), in index order. Requires an extent that is
/// not empty. Cost: O(1).
template <class F>
void for_each_box(OrderedExtent e, VoxelIndex first, VoxelIndex last, F&& f) {
  RUNSTONE_ASSERT(e.f != 0 && e.m != 0);
  while (first < last) {
    const std::uint32_t line = first / e.f;
    const std::uint32_t at = first - line * e.f;
    const std::uint32_t m = line % e.m, s = line / e.m;
    // Whole lines, if the stretch begins with a line.
    const std::uint32_t lines = (last - first) / e.f;
    VoxelIndex end = 0;
    if (at != 0 || lines == 0) {
      end = std::min(last, first - at + e.f);
      f(OrderedBox{{at, m, s}, {at + (end - first), m + 1, s + 1}});
    } else if (m != 0 || lines < e.m) {
      const std::uint32_t count = std::min(lines, e.m - m);
      end = first + count * e.f;
      f(OrderedBox{{0, m, s}, {e.f, m + count, s + 1}});
    } else {
      const std::uint32_t count = lines / e.m;
      end = first + count * e.layer();
      f(OrderedBox{{0, 0, s}, {e.f, e.m, s + count}});
    }
    first = end;
  }
}

}  // namespace runstone
