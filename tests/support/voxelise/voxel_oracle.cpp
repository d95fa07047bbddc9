#include "tests/support/voxelise/voxel_oracle.hpp"

#include <algorithm>
#include <cmath>

namespace runstone::test {
namespace {

__extension__ using Whole = __int128;
using Vec = std::array<std::int64_t, 3>;
using WideVec = std::array<Whole, 3>;
using Corners = std::array<Vec, 3>;

constexpr std::int64_t kSide = 256;

Vec minus(const Vec& a, const Vec& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
WideVec cross(const Vec& a, const Vec& b) {
  return {Whole{a[1]} * b[2] - Whole{a[2]} * b[1], Whole{a[2]} * b[0] - Whole{a[0]} * b[2],
          Whole{a[0]} * b[1] - Whole{a[1]} * b[0]};
}
Whole dot(const WideVec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
int sign_of(Whole v) { return v > 0 ? 1 : v < 0 ? -1 : 0; }
/// The sign of the volume of the tetrahedron.
int side_of(const Vec& a, const Vec& b, const Vec& c, const Vec& p) {
  return sign_of(dot(cross(minus(b, a), minus(c, a)), minus(p, a)));
}

/// Returns true if the closed segment has a point in the closed box.
bool segment_meets_box(const Vec& p, const Vec& q, const Vec& low, const Vec& high) {
  // p + t (q - p), t from lo_num / lo_den to hi_num / hi_den.
  Whole lo_num = 0, lo_den = 1, hi_num = 1, hi_den = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    std::int64_t d = q[i] - p[i], from = low[i] - p[i], to = high[i] - p[i];
    if (d == 0) {
      if (from > 0 || to < 0) return false;
      continue;
    }
    if (d < 0) {
      d = -d;
      std::swap(from, to);
      from = -from;
      to = -to;
    }
    if (Whole{from} * lo_den > lo_num * d) lo_num = from, lo_den = d;
    if (Whole{to} * hi_den < hi_num * d) hi_num = to, hi_den = d;
  }
  return lo_num * hi_den <= hi_num * lo_den;
}

/// Returns true if a point of the plane of a triangle is in the closed triangle.
bool holds_point(const Corners& t, const Vec& p) {
  const WideVec n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  if (n == WideVec{} || dot(n, minus(p, t[0])) != 0) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    const WideVec side = cross(minus(t[(i + 1) % 3], t[i]), minus(p, t[i]));
    if (side[0] * n[0] + side[1] * n[1] + side[2] * n[2] < 0) return false;
  }
  return true;
}

/// Returns true if the segment from p to q, which is not parallel to the triangle, meets the closed
/// triangle. `is_open_at_q`: q itself does not count.
bool segment_crosses(const Corners& t, const Vec& p, const Vec& q, bool is_open_at_q) {
  const int at_p = side_of(t[0], t[1], t[2], p), at_q = side_of(t[0], t[1], t[2], q);
  if (at_p == at_q) return false;  // on one side, or parallel
  if (at_p * at_q > 0) return false;
  if (at_q == 0 && is_open_at_q) return false;
  // The line passes all edges on one side.
  int low = 0, high = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const int side = side_of(p, q, t[i], t[(i + 1) % 3]);
    low = std::min(low, side);
    high = std::max(high, side);
  }
  return low == 0 || high == 0;
}

bool touches_cube(const Corners& t, const Vec& low, const Vec& high) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (segment_meets_box(t[i], t[(i + 1) % 3], low, high)) return true;
  }
  const auto corner = [&](unsigned bits) {
    return Vec{(bits & 1) != 0 ? high[0] : low[0], (bits & 2) != 0 ? high[1] : low[1],
               (bits & 4) != 0 ? high[2] : low[2]};
  };
  for (unsigned from = 0; from < 8; ++from) {
    if (holds_point(t, corner(from))) return true;
    for (const unsigned bit : {1U, 2U, 4U}) {
      if ((from & bit) == 0 && segment_crosses(t, corner(from), corner(from | bit), false))
        return true;
    }
  }
  return false;
}

}  // namespace

VoxelOracle::VoxelOracle(const Model& mesh, double voxels_per_unit) {
  std::array<double, 3> low{}, high{};
  bool is_first = true;
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t vertex : t) {
      for (std::size_t i = 0; i < 3; ++i) {
        const double v = mesh.positions[vertex][i];
        low[i] = is_first ? v : std::min(low[i], v);
        high[i] = is_first ? v : std::max(high[i], v);
      }
      is_first = false;
    }
  }
  const double units = voxels_per_unit * kSide;
  for (const auto& t : mesh.triangles) {
    Corners corners{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t i = 0; i < 3; ++i)
        corners[corner][i] = static_cast<std::int64_t>(
            std::floor((double{mesh.positions[t[corner]][i]} - low[i]) * units + 0.5));
    }
    triangles_.push_back(corners);
  }
  const auto side = [&](std::size_t i) {
    const auto length = static_cast<std::int64_t>(std::floor((high[i] - low[i]) * units + 0.5));
    return static_cast<std::int32_t>(std::max<std::int64_t>(1, (length + kSide - 1) / kSide));
  };
  sides_ = {side(0), side(1), side(2)};
}

bool VoxelOracle::is_surface(VoxelPos voxel, SurfaceMode mode) const {
  const std::array<std::int32_t, 3> at{voxel.x, voxel.y, voxel.z};
  const std::array<std::int32_t, 3> sides{sides_.x, sides_.y, sides_.z};
  const Vec low{at[0] * kSide, at[1] * kSide, at[2] * kSide};
  const Vec high{low[0] + kSide, low[1] + kSide, low[2] + kSide};
  for (const Corners& t : triangles_) {
    bool is_near = true;
    for (std::size_t i = 0; i < 3; ++i) {
      is_near = is_near && std::min({t[0][i], t[1][i], t[2][i]}) <= high[i] &&
                std::max({t[0][i], t[1][i], t[2][i]}) >= low[i];
    }
    if (!is_near) continue;
    if (mode == SurfaceMode::conservative && touches_cube(t, low, high)) return true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (mode == SurfaceMode::separating_6) {
        Vec from{low[0] + kSide / 2, low[1] + kSide / 2, low[2] + kSide / 2};
        Vec to = from;
        from[axis] = low[axis];
        to[axis] = high[axis];
        if (segment_crosses(t, from, to, at[axis] + 1 != sides[axis])) return true;
      }
      if (mode == SurfaceMode::separating_26) {
        for (unsigned edge = 0; edge < 4; ++edge) {
          const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
          Vec from{};
          from[axis] = low[axis];
          from[u] = (edge & 1) != 0 ? high[u] : low[u];
          from[v] = (edge & 2) != 0 ? high[v] : low[v];
          Vec to = from;
          to[axis] = high[axis];
          if (segment_crosses(t, from, to, false)) return true;
        }
      }
    }
  }
  return false;
}

bool VoxelOracle::is_wall(VoxelPos voxel) const {
  if (is_inside(voxel)) return false;
  const std::array<std::int32_t, 3> at{voxel.x, voxel.y, voxel.z};
  const std::array<std::int32_t, 3> sides{sides_.x, sides_.y, sides_.z};
  // Centres are moved as in crossings(), here by small numbers.
  constexpr std::int64_t kFine = std::int64_t{1} << 24;
  constexpr Vec kMoved{1 << 16, 1 << 8, 1};
  Vec middle{}, centre{};
  for (std::size_t i = 0; i < 3; ++i) {
    middle[i] = at[i] * kSide + kSide / 2;
    centre[i] = middle[i] * kFine + kMoved[i];
  }
  for (const Corners& t : triangles_) {
    Corners fine = t;
    bool is_near = true;
    for (std::size_t i = 0; i < 3; ++i) {
      is_near = is_near && std::min({t[0][i], t[1][i], t[2][i]}) <= middle[i] + kSide / 2 &&
                std::max({t[0][i], t[1][i], t[2][i]}) >= middle[i] - kSide / 2;
      for (Vec& corner : fine) corner[i] *= kFine;
    }
    if (!is_near) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      // A face between voxels belongs to the one behind it, and the last one to the last voxel.
      Vec low = middle, high = middle;
      low[axis] -= kSide / 2;
      high[axis] += kSide / 2;
      if (!segment_crosses(t, low, high, at[axis] + 1 != sides[axis])) continue;
      for (const int step : {-1, 1}) {
        std::array<std::int32_t, 3> beside = at;
        beside[axis] += step;
        Vec other = centre;
        other[axis] += step * kSide * kFine;
        if (segment_crosses(fine, centre, other, false) &&
            !is_inside({beside[0], beside[1], beside[2]}))
          return true;
      }
    }
  }
  return false;
}

int VoxelOracle::crossings(VoxelPos voxel) const {
  // The centre moves by e along x, e^2 along y, e^3 along z, for an infinitesimal e.
  const Vec p{voxel.x * kSide + kSide / 2, voxel.y * kSide + kSide / 2,
              voxel.z * kSide + kSide / 2};
  int out = 0;
  for (const Corners& t : triangles_) {
    const WideVec n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    if (n[2] == 0) continue;
    const int facing = sign_of(n[2]);
    bool is_in = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec d = minus(t[(i + 1) % 3], t[i]), to_p = minus(p, t[i]);
      int side = sign_of(Whole{d[0]} * to_p[1] - Whole{d[1]} * to_p[0]);
      if (side == 0) side = sign_of(-d[1]);
      if (side == 0) side = sign_of(d[0]);
      is_in = is_in && side == facing;
    }
    if (!is_in) continue;
    int above = sign_of(dot(n, minus(p, t[0])));
    for (std::size_t i = 0; above == 0; ++i) above = sign_of(n[i]);
    // The ray meets the triangle if the point is below it.
    if (above * facing < 0) out += facing;
  }
  return out;
}

bool VoxelOracle::is_inside(VoxelPos voxel) const {
  // Each crossing adds 1 or -1.
  return crossings(voxel) % 2 != 0;
}

std::optional<double> VoxelOracle::winding(VoxelPos voxel) const {
  const Vec p{voxel.x * kSide + kSide / 2, voxel.y * kSide + kSide / 2,
              voxel.z * kSide + kSide / 2};
  double sum = 0;
  for (const Corners& t : triangles_) {
    if (holds_point(t, p)) return std::nullopt;
    std::array<std::array<double, 3>, 3> v{};
    std::array<double, 3> length{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) v[i][k] = static_cast<double>(t[i][k] - p[k]);
      length[i] = std::sqrt(v[i][0] * v[i][0] + v[i][1] * v[i][1] + v[i][2] * v[i][2]);
    }
    const auto inner = [&](std::size_t a, std::size_t b) {
      return v[a][0] * v[b][0] + v[a][1] * v[b][1] + v[a][2] * v[b][2];
    };
    const double volume = v[0][0] * (v[1][1] * v[2][2] - v[1][2] * v[2][1]) +
                          v[0][1] * (v[1][2] * v[2][0] - v[1][0] * v[2][2]) +
                          v[0][2] * (v[1][0] * v[2][1] - v[1][1] * v[2][0]);
    const double rest = length[0] * length[1] * length[2] + inner(0, 1) * length[2] +
                        inner(1, 2) * length[0] + inner(2, 0) * length[1];
    sum += 2 * std::atan2(volume, rest);
  }
  return sum / (4 * 3.14159265358979323846);
}

}  // namespace runstone::test
