// CapsuleRow: where a line of voxels meets a capsule, that is, all points within a distance of a segment: in
// closed form and exact. Works in two dimensions as in three: then "across" has one axis less. Internal to
// edits. Integers only: distances to the segment are compared by cross-multiplication, and the two divisions
// are those of whole bounds, rounded inwards.
//
// A line runs along one axis, u from the segment's first point a. With the segment d = (df, across axes) and
// the line's offset q across: A = |d across|^2, c = q . d across, n = |q|^2, L = |d|^2 = df^2 + A. A voxel's
// place along the segment is t = u * df + c, 0 .. L. It is inside when one of these holds:
//   the ball at a:    u^2 <= R - n
//   the ball at b:    (u - df)^2 <= R - n + 2c - A
//   between them:     0 <= t <= L and (u^2 + n) * L - t^2 <= R * L, that is, A u^2 - 2 df c u + .. <= 0,
//                     with the roots (df c +- sqrt(L * E)) / A, E = c^2 + A * (R - n)
// A capsule is convex, so the three rows of a line, each the whole numbers of an interval, join gapless.
//
// No overflow: segments reach at most S = 1,024 along an axis and R = r * r + r with r <= 512; callers ask
// for lines within r of the segment's bounding box only. So |q| per axis <= S + r = 1,536 and
//   A <= 2 S^2 = 2^21, L <= 3 S^2 < 2^21.6, R < 2^18.01, n <= 2 * 1,536^2 < 2^22.2, |c| < 2^21.6;
//   |E| <= c^2 + A * max(R, n) < 2^44.2, and where E >= 0 counts, E <= A * R < 2^39.1 since c^2 <= A * n;
//   L * E < 2^60.7 and |df * c| < 2^31.6: all fit i64.
#pragma once
#include <algorithm>
#include <cstdint>

namespace runstone {

/// Whole numbers first .. last, both included; empty if last < first.
struct CapsuleRow {
  std::int64_t first = 0, last = -1;
  constexpr bool empty() const { return last < first; }
  friend bool operator==(const CapsuleRow&, const CapsuleRow&) = default;
};

/// Largest w with w * w <= v, by Newton's steps from any `guess` >= 1: two or three where the guess is near,
/// as it is from line to line; at most about 35. Requires v < 2^62.
constexpr std::uint64_t isqrt_near(std::uint64_t v, std::uint64_t guess) {
  if (v == 0) return 0;
  // One step from anywhere leads to the root or above it; from there each step goes down until it is reached.
  std::uint64_t root = (guess + v / guess) / 2;
  for (;;) {
    const std::uint64_t next = (root + v / root) / 2;
    if (next >= root) return root;
    root = next;
  }
}

/// The square roots of the line before, to begin with.
struct CapsuleRoots {
  std::uint64_t body = 1, start = 1, end = 1;
};

namespace detail {

constexpr std::int64_t floor_of(std::int64_t a, std::int64_t b) {  // b > 0
  return a / b - static_cast<std::int64_t>(a % b < 0);
}
constexpr std::int64_t ceil_of(std::int64_t a, std::int64_t b) { return -floor_of(-a, b); }

constexpr std::int64_t root_of(std::int64_t v, std::uint64_t& guess) {
  const std::uint64_t root = isqrt_near(static_cast<std::uint64_t>(v), guess);
  guess = std::max<std::uint64_t>(root, 1);
  return static_cast<std::int64_t>(root);
}

constexpr void join(CapsuleRow& row, std::int64_t first, std::int64_t last) {
  if (last < first) return;
  row = row.empty() ? CapsuleRow{first, last}
                    : CapsuleRow{std::min(row.first, first), std::max(row.last, last)};
}

}  // namespace detail

/// The row of the line with these numbers (file comment), counted from the segment's first point. O(1).
inline CapsuleRow capsule_row(std::int64_t df, std::int64_t across, std::int64_t c, std::int64_t n,
                              std::int64_t reach, CapsuleRoots& roots) {
  if (df < 0) {
    const CapsuleRow mirrored = capsule_row(-df, across, c, n, reach, roots);
    return {-mirrored.last, -mirrored.first};
  }
  const std::int64_t start_left = reach - n;
  if (across == 0) {  // the line runs along the segment
    if (start_left < 0) return {};
    const std::int64_t half = detail::root_of(start_left, roots.start);
    return {-half, df + half};
  }
  const std::int64_t length = df * df + across;
  const std::int64_t e = c * c + across * start_left;
  if (e < 0) return {};
  const std::int64_t root = detail::root_of(length * e, roots.body);
  CapsuleRow body{detail::ceil_of(df * c - root, across), detail::floor_of(df * c + root, across)};
  if (body.empty()) return {};  // no voxel within reach of the endless line, and so none of the segment
  if (body.first * df + c >= 0 && body.last * df + c <= length) return body;
  if (df == 0) {
    if (c < 0 || c > length) body = {};
  } else {
    body.first = std::max(body.first, detail::ceil_of(-c, df));
    body.last = std::min(body.last, detail::floor_of(length - c, df));
  }
  CapsuleRow row = body.empty() ? CapsuleRow{} : body;
  if (start_left >= 0) {
    const std::int64_t half = detail::root_of(start_left, roots.start);
    detail::join(row, -half, half);
  }
  const std::int64_t end_left = start_left + 2 * c - across;
  if (end_left >= 0) {
    const std::int64_t half = detail::root_of(end_left, roots.end);
    detail::join(row, df - half, df + half);
  }
  return row;
}

}  // namespace runstone
