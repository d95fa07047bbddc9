// The voxels whose closed cubes a triangle touches, as rows along x. Exact, also for triangles
// without area. Internal to this room. Source: the tests of Schwarz and Seidel, "Fast parallel
// surface and solid voxelization on GPUs" (2010): bounding box, plane, and the projections along
// the three axes. Each is linear in x, so that the voxels of a row are an interval.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/voxelise/exact_math.hpp"
#include "common/voxelise/line_crossings.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

/// Calls f(y, z, first x, last x) for each row in which voxels are touched. `voxels` bounds x, y
/// and z, both ends included. Cost: O(rows of the bounding box).
template <class F>
void for_each_touched(const UnitTriangle& t, const LineRanges& voxels, F&& f) {
  std::array<WholeRange, 3> box;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const auto [low, high] = std::minmax({t[0][axis], t[1][axis], t[2][axis]});
    box[axis] = {std::max<std::int64_t>(((low + kVoxelUnit - 1) >> 8) - 1, voxels.low[axis]),
                 std::min<std::int64_t>(high >> 8, voxels.high[axis])};
    if (box[axis].empty()) return;
  }
  // A condition: by[0] x + by[1] y + by[2] z + at_zero >= 0, by number of a voxel.
  struct Condition {
    std::array<std::int64_t, 3> by{};
    std::int64_t at_zero = 0;
  };
  const auto edge = [&](std::size_t from, std::size_t to, unsigned along) {
    return std::int64_t{t[to][along]} - t[from][along];
  };
  std::array<std::int64_t, 3> normal{};
  for (unsigned w = 0; w < 3; ++w) {
    const unsigned u = (w + 1) % 3, v = (w + 2) % 3;
    normal[w] = edge(0, 1, u) * edge(0, 2, v) - edge(0, 1, v) * edge(0, 2, u);
  }
  // Groups by the axis along which the conditions do not change; [3] are those of the plane.
  std::array<std::array<Condition, 6>, 4> conditions{};
  std::array<std::size_t, 4> counts{};
  for (unsigned w = 0; w < 3; ++w) {
    const unsigned u = (w + 1) % 3, v = (w + 2) % 3;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t to = (i + 1) % 3;
      // Inside of the edge is the positive side. A projection without area has both sides.
      for (const std::int64_t sign : {1, -1}) {
        if (normal[w] * sign < 0) continue;
        Condition& c = conditions[w][counts[w]++];
        const std::int64_t by_u = -sign * edge(i, to, v), by_v = sign * edge(i, to, u);
        c.by[u] = by_u * kVoxelUnit;
        c.by[v] = by_v * kVoxelUnit;
        c.at_zero =
            -by_u * t[i][u] - by_v * t[i][v] +
            kVoxelUnit * (std::max<std::int64_t>(by_u, 0) + std::max<std::int64_t>(by_v, 0));
      }
    }
  }
  for (const std::int64_t sign : {1, -1}) {
    Condition& c = conditions[3][counts[3]++];
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::int64_t by = sign * normal[axis];
      c.by[axis] = by * kVoxelUnit;
      c.at_zero += kVoxelUnit * std::max<std::int64_t>(by, 0) - by * t[0][axis];
    }
  }
  for (std::int64_t z = box[2].low; z <= box[2].high; ++z) {
    WholeRange of_z = box[0];
    for (std::size_t i = 0; i < counts[1]; ++i)
      of_z.keep(conditions[1][i].by[0], conditions[1][i].by[2] * z + conditions[1][i].at_zero);
    WholeRange ys = of_z.empty() ? WholeRange{} : box[1];
    for (std::size_t i = 0; i < counts[0]; ++i)
      ys.keep(conditions[0][i].by[1], conditions[0][i].by[2] * z + conditions[0][i].at_zero);
    for (std::int64_t y = ys.low; y <= ys.high; ++y) {
      WholeRange xs = of_z;
      for (std::size_t i = 0; i < counts[2]; ++i)
        xs.keep(conditions[2][i].by[0], conditions[2][i].by[1] * y + conditions[2][i].at_zero);
      for (std::size_t i = 0; i < counts[3]; ++i) {
        const Condition& c = conditions[3][i];
        xs.keep(c.by[0], c.by[1] * y + c.by[2] * z + c.at_zero);
      }
      if (!xs.empty())
        f(static_cast<std::int32_t>(y), static_cast<std::int32_t>(z),
          static_cast<std::int32_t>(xs.low), static_cast<std::int32_t>(xs.high));
    }
  }
}

}  // namespace runstone
