// RowRuns: the voxels of one row along any axis, as stretches of one material. Internal to rdm.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/ids.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone::rdm {

struct RowRuns {
  /// Covers [end of the previous stretch, end).
  struct Stretch {
    std::uint8_t end;
    Material material;
  };
  std::array<Stretch, kSideMax> stretch;
  std::uint32_t count = 0;

  void clear() { count = 0; }
  /// Adds voxels up to `end`. They join the last stretch if it has the same material.
  void append(std::uint32_t end, Material material) {
    if (count == 0 || stretch[count - 1].material != material) ++count;
    stretch[count - 1] = {static_cast<std::uint8_t>(end), material};
  }
};

/// A row of voxels along the third axis: those with `layer` = at and `row_axis` = row.
struct RowPlace {
  Axis layer;
  std::uint32_t at;
  Axis row_axis;
  std::uint32_t row;
};

/// Reads `count` rows side by side into out[0], out[1], ...: the rows of the layers from place.at
/// on. Cost per row: O(length + log runs + runs between the first voxel and the last). If the
/// layers lie along the fastest axis, the cost of all rows together is O(length * log runs).
template <class Runs>
void read_rows(const Runs& runs, const RunChunk& chunk, const RowPlace& place, unsigned count,
               RowRuns* out) {
  std::uint32_t voxel = 0;
  std::uint32_t step = 0;
  std::uint32_t across = 0;
  std::uint32_t length = 0;
  std::uint32_t stride = 1;
  for (const Axis axis : axes_of(chunk.order)) {
    const std::uint32_t side = chunk.extent.sides()[static_cast<std::size_t>(axis)];
    if (axis == place.layer) {
      voxel += place.at * stride;
      across = stride;
    } else if (axis == place.row_axis) {
      voxel += place.row * stride;
    } else {
      step = stride;
      length = side;
    }
    stride *= side;
  }
  for (unsigned r = 0; r < count; ++r) out[r].clear();
  if (across == 1) {  // the rows are adjacent in the list of runs: one walk for all
    RunCursor cursor(runs);
    for (std::uint32_t i = 0; i < length; ++i) {
      const std::uint32_t first = voxel + i * step;
      for (unsigned r = 0; r < count; ++r) {
        if (r == 0) {
          cursor.jump(first);
        } else if (cursor.end() <= first + r) {
          cursor.next();
        }
        out[r].append(i + 1, cursor.material());
      }
    }
    return;
  }
  for (unsigned r = 0; r < count; ++r) {
    RunCursor cursor(runs);
    const std::uint32_t first = voxel + r * across;
    cursor.jump(first);
    for (std::uint32_t i = 0; i < length;) {
      const std::uint32_t at = first + i * step;
      if (cursor.end() <= at) cursor.seek(at);
      const std::uint32_t left = cursor.end() - at;
      if (step == 1) {
        i = std::min(i + left, length);
      } else if (left > step) {
        i = std::min(i + (left + step - 1) / step, length);
      } else {
        ++i;
      }
      out[r].append(i, cursor.material());
    }
  }
}

}  // namespace runstone::rdm
