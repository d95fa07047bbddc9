// Row stretches: voxels of a row along x as stretches, and operations on such rows.
#pragma once
#include <cstdint>
#include <vector>

namespace runstone {

/// Voxels [low, high) of a row.
struct RowStretch {
  std::int32_t low = 0, high = 0;
  friend bool operator==(const RowStretch&, const RowStretch&) = default;
};

/// Sorts stretches and joins those that overlap or touch.
void join_stretches(std::vector<RowStretch>& row);

/// Removes the stretches `inside` from those of `row`. Both ascend. `left` is scratch.
void subtract_stretches(const std::vector<RowStretch>& inside, std::vector<RowStretch>& row,
                        std::vector<RowStretch>& left);

/// Returns what two rows have in common. Both ascend.
std::vector<RowStretch> common_stretches(const std::vector<RowStretch>& a,
                                         const std::vector<RowStretch>& b);

}  // namespace runstone
