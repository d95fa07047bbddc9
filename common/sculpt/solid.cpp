#include "common/sculpt/solid.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "common/core/assert.hpp"
#include "common/sculpt/row_build.hpp"

namespace runstone {
namespace {

/// A centre that lies on the surface belongs to the solid, whatever way its place was rounded.
constexpr double kRounding = 1e-9;

/// A solid whose axis is y, in a box at `at`. It gives the rows along x.
class UprightSolid {
 public:
  UprightSolid(SolidKind kind, VoxelPos at, VoxelPos sides) : kind_(kind), at_(at), sides_(sides) {}

  bool is_empty() const { return sides_.x < 1 || sides_.y < 1 || sides_.z < 1; }

  /// Appends the stretches of a row, from low to high.
  void row(std::int32_t y, std::int32_t z, std::vector<RowStretch>& out) const {
    y -= at_.y;
    z -= at_.z;
    if (is_empty() || y < 0 || y >= sides_.y || z < 0 || z >= sides_.z) return;
    // Places of voxel centres, from -1 to 1 across the box.
    const double v = (2.0 * y + 1 - sides_.y) / sides_.y, w = (2.0 * z + 1 - sides_.z) / sides_.z;
    const double up = (y + 0.5) / sides_.y;
    switch (kind_) {
      case SolidKind::ellipsoid:
        return add_within(root(1 - v * v - w * w), out);
      case SolidKind::dome:
        return add_within(root(1 - up * up - w * w), out);
      case SolidKind::cylinder:
        return add_within(root(1 - w * w), out);
      case SolidKind::cone:
        return add_within(root((1 - up) * (1 - up) - w * w), out);
      case SolidKind::pyramid:
        if (std::abs(w) <= 1 - up + kRounding) add_within(1 - up, out);
        return;
      case SolidKind::torus:
        return add_ring(v, w, out);
    }
  }

 private:
  static std::optional<double> root(double square) {
    if (square < -kRounding) return std::nullopt;
    return std::sqrt(std::max(0.0, square));
  }
  /// Returns the voxels whose centres are at most this far from the middle, as a share of the half
  /// side.
  RowStretch within(double half_width) const {
    const double reach = half_width * sides_.x;
    const auto low = static_cast<std::int32_t>(std::ceil((sides_.x - 1 - reach) / 2 - kRounding));
    return {std::max(0, low), std::min(sides_.x, sides_.x - low)};
  }
  void add(RowStretch part, std::vector<RowStretch>& out) const {
    if (part.low < part.high) out.push_back({part.low + at_.x, part.high + at_.x});
  }
  void add_within(std::optional<double> half_width, std::vector<RowStretch>& out) const {
    if (half_width) add(within(*half_width), out);
  }
  void add_ring(double v, double w, std::vector<RowStretch>& out) const {
    const double tube = std::min(0.5, static_cast<double>(sides_.y) / std::min(sides_.x, sides_.z));
    const auto spread = root(1 - v * v);
    if (!spread) return;
    const double outer = 1 - tube + tube * *spread, inner = 1 - tube - tube * *spread;
    const auto whole = root(outer * outer - w * w);
    if (!whole) return;
    const RowStretch all = within(*whole);
    // A voxel whose centre lies on the inner circle belongs to the ring.
    const double square = inner * inner - w * w;
    if (inner <= 0 || square <= 0) return add(all, out);
    const double reach = std::sqrt(square) * sides_.x;
    const auto low =
        static_cast<std::int32_t>(std::floor((sides_.x - 1 - reach) / 2 + kRounding)) + 1;
    if (low >= sides_.x - low) return add(all, out);
    add({all.low, low}, out);
    add({sides_.x - low, all.high}, out);
  }

  const SolidKind kind_;
  const VoxelPos at_;
  const VoxelPos sides_;
};

UprightSolid hollow_of(const Solid& solid, VoxelPos sides) {
  const std::int32_t wall = solid.wall;
  VoxelPos at{wall, wall, wall};
  VoxelPos inside{sides.x - 2 * wall, sides.y - 2 * wall, sides.z - 2 * wall};
  if (solid.fill == SolidFill::solid) return {solid.kind, at, {0, 0, 0}};
  if (solid.fill == SolidFill::walls && solid.kind != SolidKind::torus) {
    at.y = 0;
    inside.y = sides.y;
  } else if (solid.kind == SolidKind::dome) {
    at.y = 0;
    inside.y = sides.y - wall;
  }
  return {solid.kind, at, inside};
}

}  // namespace

Result<BuildPtr> solid_build(const Solid& solid, VoxelPos sides, Material material) {
  RUNSTONE_ASSERT(sides.x > 0 && sides.y > 0 && sides.z > 0 && solid.wall > 0);
  if (std::max({sides.x, sides.y, sides.z}) > kSolidSideMax)
    return fail(ErrorCode::limit_exceeded, "the solid is longer than 1,024 voxels");
  const VoxelPos box = with_upright(sides, solid.axis);
  const UprightSolid body(solid.kind, {0, 0, 0}, box), hollow = hollow_of(solid, box);
  std::vector<RowStretch> inside, left;
  return build_of_rows(box, solid.axis, material,
                       [&](std::int32_t y, std::int32_t z, std::vector<RowStretch>& row) {
                         inside.clear();
                         body.row(y, z, row);
                         hollow.row(y, z, inside);
                         subtract_stretches(inside, row, left);
                       });
}

}  // namespace runstone
