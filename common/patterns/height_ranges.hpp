// HeightRanges: sets of voxels of one column. Internal to patterns.
#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

namespace runstone {

/// The voxels [low, high) of a column.
struct HeightRange {
  std::int32_t low = 0, high = 0;
  friend bool operator==(const HeightRange&, const HeightRange&) = default;
};

/// Ranges that ascend and do not touch.
using HeightRanges = std::vector<HeightRange>;

/// Appends a range, which may touch the last one. Does nothing if it is empty. Requires that it
/// lies above those before.
inline void append_range(HeightRanges& to, std::int32_t low, std::int32_t high) {
  if (low >= high) return;
  if (!to.empty() && to.back().high == low) {
    to.back().high = high;
  } else {
    to.push_back({low, high});
  }
}

/// Returns what lies in one of them, in both, and in the first but not in the second. Cost:
/// O(ranges).
HeightRanges union_of(const HeightRanges& a, const HeightRanges& b);
HeightRanges common_of(const HeightRanges& a, const HeightRanges& b);
HeightRanges without(const HeightRanges& a, const HeightRanges& b);

}  // namespace runstone
