#include "common/sculpt/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "common/builds/build_builder.hpp"
#include "common/builds/paste_source.hpp"
#include "common/core/assert.hpp"
#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

/// A centre that lies on the surface belongs to the solid, whatever way its place was rounded.
constexpr double kRounding = 1e-9;

/// Voxels [low, high) of a row.
struct Stretch {
  std::int32_t low = 0, high = 0;
};

/// A solid whose axis is y, in a box at `at`. It gives the rows along x.
class UprightSolid {
 public:
  UprightSolid(SolidKind kind, VoxelPos at, VoxelPos sides) : kind_(kind), at_(at), sides_(sides) {}

  bool is_empty() const { return sides_.x < 1 || sides_.y < 1 || sides_.z < 1; }

  /// Appends the stretches of a row, from low to high.
  void row(std::int32_t y, std::int32_t z, std::vector<Stretch>& out) const {
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
  Stretch within(double half_width) const {
    const double reach = half_width * sides_.x;
    const auto low = static_cast<std::int32_t>(std::ceil((sides_.x - 1 - reach) / 2 - kRounding));
    return {std::max(0, low), std::min(sides_.x, sides_.x - low)};
  }
  void add(Stretch part, std::vector<Stretch>& out) const {
    if (part.low < part.high) out.push_back({part.low + at_.x, part.high + at_.x});
  }
  void add_within(std::optional<double> half_width, std::vector<Stretch>& out) const {
    if (half_width) add(within(*half_width), out);
  }
  void add_ring(double v, double w, std::vector<Stretch>& out) const {
    const double tube = std::min(0.5, static_cast<double>(sides_.y) / std::min(sides_.x, sides_.z));
    const auto spread = root(1 - v * v);
    if (!spread) return;
    const double outer = 1 - tube + tube * *spread, inner = 1 - tube - tube * *spread;
    const auto whole = root(outer * outer - w * w);
    if (!whole) return;
    const Stretch all = within(*whole);
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

/// Removes the stretches `inside` from those of `row`. Both ascend. `left` is scratch.
void subtract(const std::vector<Stretch>& inside, std::vector<Stretch>& row,
              std::vector<Stretch>& left) {
  for (const Stretch& hole : inside) {
    left.clear();
    for (const Stretch& part : row) {
      if (part.low < std::min(part.high, hole.low))
        left.push_back({part.low, std::min(part.high, hole.low)});
      if (std::max(part.low, hole.high) < part.high)
        left.push_back({std::max(part.low, hole.high), part.high});
    }
    row.swap(left);
  }
}

/// Exchanges y with the axis of the solid. The exchange is its own inverse.
template <class T>
std::array<T, 3> exchanged(std::array<T, 3> of, Axis axis) {
  std::swap(of[1], of[static_cast<std::size_t>(axis)]);
  return of;
}

AxisOrder order_of(Axis axis) {
  if (axis == Axis::x) return AxisOrder::yxz;
  if (axis == Axis::z) return AxisOrder::xzy;
  return AxisOrder::xyz;
}

}  // namespace

Result<BuildPtr> solid_build(const Solid& solid, VoxelPos sides, Material material) {
  RUNSTONE_ASSERT(sides.x > 0 && sides.y > 0 && sides.z > 0 && solid.wall > 0);
  if (std::max({sides.x, sides.y, sides.z}) > kSolidSideMax)
    return fail(ErrorCode::limit_exceeded, "the solid is longer than 1,024 voxels");
  // Everything is made with the axis upright; the names of the axes are exchanged at the end.
  const auto upright = exchanged(std::array{sides.x, sides.y, sides.z}, solid.axis);
  const VoxelPos box{upright[0], upright[1], upright[2]};
  const UprightSolid body(solid.kind, {0, 0, 0}, box), hollow = hollow_of(solid, box);
  const BuildCuts cuts = {grid_cuts(box.x, kPasteBlockEdge), grid_cuts(box.y, kPasteBlockEdge),
                          grid_cuts(box.z, kPasteBlockEdge)};
  auto builder = BuildBuilder::of(exchanged(cuts, solid.axis));
  if (!builder) return failure(builder.error());
  const std::uint16_t number = *builder->number_of(material);
  std::vector<Stretch> row, inside, left;
  for (std::uint32_t sz = 0; sz + 1 < cuts[2].size(); ++sz) {
    for (std::uint32_t sy = 0; sy + 1 < cuts[1].size(); ++sy) {
      // The rows of a line of sections are made once for all of them.
      std::vector<std::optional<RunBuilder>> sections(cuts[0].size() - 1);
      const std::int32_t height = cuts[1][sy + 1] - cuts[1][sy],
                         depth = cuts[2][sz + 1] - cuts[2][sz];
      for (std::int32_t z = 0; z < depth; ++z) {
        for (std::int32_t y = 0; y < height; ++y) {
          row.clear();
          inside.clear();
          body.row(cuts[1][sy] + y, cuts[2][sz] + z, row);
          hollow.row(cuts[1][sy] + y, cuts[2][sz] + z, inside);
          subtract(inside, row, left);
          for (std::size_t sx = 0; sx < sections.size(); ++sx) {
            const std::int32_t low = cuts[0][sx], high = cuts[0][sx + 1], side = high - low;
            for (const Stretch& part : row) {
              const std::int32_t from = std::max(low, part.low), to = std::min(high, part.high);
              if (from >= to) continue;
              if (!sections[sx]) {
                const auto extent = exchanged(
                    std::array{static_cast<std::uint8_t>(side), static_cast<std::uint8_t>(height),
                               static_cast<std::uint8_t>(depth)},
                    solid.axis);
                sections[sx].emplace(Extent{extent[0], extent[1], extent[2]}, order_of(solid.axis));
              }
              const auto start = static_cast<std::uint32_t>(side * (y + height * z));
              sections[sx]->append_to(start + static_cast<std::uint32_t>(from - low), 0);
              sections[sx]->append(static_cast<std::uint32_t>(to - from), number);
            }
          }
        }
      }
      for (std::uint32_t sx = 0; sx < sections.size(); ++sx) {
        if (!sections[sx]) continue;
        const std::int32_t side = cuts[0][sx + 1] - cuts[0][sx];
        sections[sx]->append_to(static_cast<std::uint32_t>(side * height * depth), 0);
        const auto at = exchanged(std::array{sx, sy, sz}, solid.axis);
        if (const auto put = builder->put({at[0], at[1], at[2]}, sections[sx]->finish()); !put)
          return failure(put.error());
      }
    }
  }
  return builder->finish();
}

}  // namespace runstone
