// CapsuleRow: the voxels of a line that lie in a capsule, that is, within a distance of a segment.
// The formula is closed and exact. It also works in two dimensions, where "across" has one axis
// less. It uses integers only: distances to the segment are compared by cross-multiplication, and
// the only two divisions compute integer bounds, rounded inwards. Internal to edits.
//
// A line runs along one axis; u counts from the segment's first point a. With the segment d = (df,
// across axes) and the line's offset q across: A = |d across|^2, c = q . d across, n = |q|^2, L =
// |d|^2 = df^2 + A. A voxel's place along the segment is t = u * df + c, 0 .. L. It is inside when
// one of these holds:
//   the ball at a:    u^2 <= R - n
//   the ball at b:    (u - df)^2 <= R - n + 2c - A
//   between them:     0 <= t <= L and (u^2 + n) * L - t^2 <= R * L,
//                     that is, A u^2 - 2 df c u + .. <= 0, with the roots
//                     (df c +- sqrt(L * E)) / A, where E = c^2 + A * (R - n)
// A capsule is convex. So the three rows of a line, each of which is an interval of integers, join
// without a gap.
//
// No number overflows: segments reach at most S = 1,024 along an axis and R = r * r + r with r <=
// 512. Callers pass only lines within r of the segment's bounding box. So |q| per axis <= S + r =
// 1,536 and
//   A <= 2 S^2 = 2^21, L <= 3 S^2 < 2^21.6, R < 2^18.01, n <= 2 * 1,536^2 < 2^22.2, |c| < 2^21.6;
//   |E| <= c^2 + A * max(R, n) < 2^44.2, and where E >= 0 counts, E <= A * R < 2^39.1 since
//   c^2 <= A * n;
//   L * E < 2^60.7 and |df * c| < 2^31.6: all fit i64.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/core/integer_root.hpp"

namespace runstone {

/// The integers first .. last, both included. The row is empty if last < first.
struct CapsuleRow {
  std::int64_t first = 0, last = -1;
  constexpr bool empty() const { return last < first; }
  friend bool operator==(const CapsuleRow&, const CapsuleRow&) = default;
};

namespace detail {

constexpr std::int64_t floor_of(std::int64_t a, std::int64_t b) {  // requires b > 0
  return a / b - static_cast<std::int64_t>(a % b < 0);
}
constexpr std::int64_t ceil_of(std::int64_t a, std::int64_t b) { return -floor_of(-a, b); }

constexpr void join(CapsuleRow& row, std::int64_t first, std::int64_t last) {
  if (last < first) return;
  row = row.empty() ? CapsuleRow{first, last}
                    : CapsuleRow{std::min(row.first, first), std::max(row.last, last)};
}

}  // namespace detail

/// Returns the row of the line with these numbers, which the comment of this file defines. It
/// counts from the segment's first point. Cost: O(1).
inline CapsuleRow capsule_row(std::int64_t df, std::int64_t across, std::int64_t c, std::int64_t n,
                              std::int64_t reach) {
  if (df < 0) {
    const CapsuleRow mirrored = capsule_row(-df, across, c, n, reach);
    return {-mirrored.last, -mirrored.first};
  }
  const std::int64_t start_left = reach - n;
  if (across == 0) {  // the line runs along the segment
    if (start_left < 0) return {};
    const std::int64_t half = integer_root(start_left);
    return {-half, df + half};
  }
  const std::int64_t length = df * df + across;
  const std::int64_t e = c * c + across * start_left;
  if (e < 0) return {};
  const std::int64_t root = integer_root(length * e);
  CapsuleRow body{detail::ceil_of(df * c - root, across), detail::floor_of(df * c + root, across)};
  // No voxel is within reach of the infinite line, so none is within reach of the segment.
  if (body.empty()) return {};
  if (body.first * df + c >= 0 && body.last * df + c <= length) return body;
  if (df == 0) {
    if (c < 0 || c > length) body = {};
  } else {
    body.first = std::max(body.first, detail::ceil_of(-c, df));
    body.last = std::min(body.last, detail::floor_of(length - c, df));
  }
  CapsuleRow row = body.empty() ? CapsuleRow{} : body;
  if (start_left >= 0) {
    const std::int64_t half = integer_root(start_left);
    detail::join(row, -half, half);
  }
  const std::int64_t end_left = start_left + 2 * c - across;
  if (end_left >= 0) {
    const std::int64_t half = integer_root(end_left);
    detail::join(row, df - half, df + half);
  }
  return row;
}

}  // namespace runstone
