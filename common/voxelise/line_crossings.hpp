// Where a triangle crosses lines that are parallel to an axis. Everything is exact.
// Internal to this room and to its benchmark.
//
// The rule for points on an edge: *closed* counts the edges and vertices of a triangle. *Half-open*
// moves the lines by an infinitesimal along x, by an infinitely smaller one along y, and again
// along z, so that no line meets an edge: a line through an edge that two triangles share crosses
// exactly one of them if they lie on either side of it, and both or none if they lie on one side.
// This is the top-left rule of rasterisers, as simulation of simplicity (Edelsbrunner, Muecke
// 1990).
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/voxelise/exact_math.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

/// The point of a line where the triangle crosses it, num / den units. den > 0, num >= 0.
struct Crossing {
  std::int64_t num = 0, den = 1;
  bool is_positive = false;  // the normal of the triangle points along the axis

  /// Returns the first voxel whose centre is at this point or behind it.
  std::int32_t first_centre() const {
    const auto n = static_cast<std::uint64_t>(num), d = static_cast<std::uint64_t>(den);
    return static_cast<std::int32_t>((n + d * (kVoxelUnit / 2) - 1) / (d * kVoxelUnit));
  }
  /// Returns true if the point is the centre of a voxel.
  bool is_on_centre() const {
    return num % (den * (kVoxelUnit / 2)) == 0 && num / (den * (kVoxelUnit / 2)) % 2 == 1;
  }
  /// Returns the voxel whose half-open interval holds the point.
  std::int32_t voxel() const { return static_cast<std::int32_t>(num / (den * kVoxelUnit)); }
  /// Returns true if the point is on the plane between voxel() and the voxel before it.
  bool is_on_plane() const { return num % (den * kVoxelUnit) == 0; }
};

/// Lines by number along each axis, both ends included. The range along the axis of the lines is
/// unused.
struct LineRanges {
  std::array<std::int32_t, 3> low{}, high{};
};

/// Calls f(numbers along x, y, z of the line, with 0 along `axis`; Crossing) for each line parallel
/// to `axis` that the triangle crosses in one point. Line i lies at i * kVoxelUnit + offset.
/// Triangles parallel to the axis cross no line. Cost: O(1), and O(1) for each row of the lines in
/// the bounding box, and for each crossing.
template <bool kHalfOpen, class F>
void for_each_crossing(const UnitTriangle& t, unsigned axis, std::int32_t offset,
                       const LineRanges& lines, F&& f) {
  const unsigned m = (axis + 1) % 3, s = (axis + 2) % 3;
  const auto numbers = [&](unsigned along) {
    const auto [low, high] = std::minmax({t[0][along], t[1][along], t[2][along]});
    return WholeRange{
        std::max<std::int64_t>((low - offset + kVoxelUnit - 1) >> 8, lines.low[along]),
        std::min<std::int64_t>((high - offset) >> 8, lines.high[along])};
  };
  static_assert(kVoxelUnit == 1 << 8);
  const WholeRange ms = numbers(m), ss = numbers(s);
  if (ms.empty() || ss.empty()) return;
  const auto edge = [&](std::size_t from, std::size_t to, unsigned along) {
    return std::int64_t{t[to][along]} - t[from][along];
  };
  const std::int64_t n = edge(0, 1, m) * edge(0, 2, s) - edge(0, 1, s) * edge(0, 2, m);
  if (n == 0) return;
  const std::int64_t sign = n > 0 ? 1 : -1;
  // Function i is at least 0 on the inner side of edge i: by number of a line along m and s.
  std::array<std::int64_t, 3> by_m{}, by_s{}, at_zero{};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t to = (i + 1) % 3;
    const std::int64_t dm = -sign * edge(i, to, s), ds = sign * edge(i, to, m);
    at_zero[i] = dm * (offset - t[i][m]) + ds * (offset - t[i][s]);
    by_m[i] = dm * kVoxelUnit;
    by_s[i] = ds * kVoxelUnit;
    if constexpr (kHalfOpen) {
      const std::int64_t first = m < s ? dm : ds, second = m < s ? ds : dm;
      if (first < 0 || (first == 0 && second < 0)) --at_zero[i];
    }
  }
  const std::int64_t n_m = edge(0, 1, s) * edge(0, 2, axis) - edge(0, 1, axis) * edge(0, 2, s);
  const std::int64_t n_s = edge(0, 1, axis) * edge(0, 2, m) - edge(0, 1, m) * edge(0, 2, axis);
  // The plane is n (x - x0) + n_m (m - m0) + n_s (s - s0) = 0.
  const std::int64_t den = n * sign;
  const std::int64_t num_at_zero =
      den * t[0][axis] - sign * (n_m * (offset - t[0][m]) + n_s * (offset - t[0][s]));
  const std::int64_t num_by_m = -sign * n_m * kVoxelUnit, num_by_s = -sign * n_s * kVoxelUnit;
  std::array<std::int32_t, 3> line{};
  for (std::int64_t at_s = ss.low; at_s <= ss.high; ++at_s) {
    WholeRange inner = ms;
    for (std::size_t i = 0; i < 3; ++i) inner.keep(by_m[i], by_s[i] * at_s + at_zero[i]);
    line[s] = static_cast<std::int32_t>(at_s);
    for (std::int64_t at_m = inner.low; at_m <= inner.high; ++at_m) {
      line[m] = static_cast<std::int32_t>(at_m);
      f(line, Crossing{num_at_zero + num_by_m * at_m + num_by_s * at_s, den, n > 0});
    }
  }
}

}  // namespace runstone
