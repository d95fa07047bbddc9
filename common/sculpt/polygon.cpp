#include "common/sculpt/polygon.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/sculpt/row_build.hpp"

namespace runstone {
namespace {

using Rows = std::vector<std::vector<RowStretch>>;  // along x, by z

/// A place in the plane of the polygon, from the corner of its box.
struct Corner {
  std::int32_t x = 0, z = 0;
  friend auto operator<=>(const Corner&, const Corner&) = default;
};

/// Where a side crosses the middle of a row: numerator / denominator, which is positive.
struct Crossing {
  std::int64_t numerator = 0, denominator = 1;
};

std::int64_t floor_of_quotient(std::int64_t a, std::int64_t b) {
  return a / b - (a % b != 0 && a < 0 ? 1 : 0);
}

/// Returns a / b rounded to the nearest whole number, and halves up. Requires b > 0.
std::int32_t rounded_quotient(std::int64_t a, std::int64_t b) {
  return static_cast<std::int32_t>(floor_of_quotient(2 * a + b, 2 * b));
}

void add_line(Corner a, Corner b, Rows& out) {
  // Both directions of a side give the same line.
  if (b < a) std::swap(a, b);
  const auto add = [&](std::int32_t x, std::int32_t z) {
    out[static_cast<std::size_t>(z)].push_back({x, x + 1});
  };
  const std::int64_t dx = b.x - a.x, dz = b.z - a.z;
  if (dx >= std::abs(dz)) {
    add(a.x, a.z);
    for (std::int32_t x = a.x + 1; x <= b.x; ++x)
      add(x, a.z + rounded_quotient((x - a.x) * dz, dx));
    return;
  }
  const std::int32_t way = dz > 0 ? 1 : -1;
  for (std::int32_t z = a.z; z != b.z + way; z += way)
    add(a.x + rounded_quotient((z - a.z) * way * dx, dz * way), z);
}

/// Adds the columns of a row whose middle lies inside.
void add_inside(std::span<const Corner> corners, std::int32_t z, std::vector<Crossing>& crossings,
                std::vector<RowStretch>& out) {
  crossings.clear();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    Corner a = corners[i], b = corners[(i + 1) % corners.size()];
    if (b.z < a.z) std::swap(a, b);
    if (z < a.z || z >= b.z) continue;
    const std::int64_t depth = b.z - a.z;
    crossings.push_back({a.x * depth + std::int64_t{z - a.z} * (b.x - a.x), depth});
  }
  std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return a.numerator * b.denominator < b.numerator * a.denominator;
  });
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
    const Crossing &in = crossings[i], &end = crossings[i + 1];
    const auto low = static_cast<std::int32_t>(-floor_of_quotient(-in.numerator, in.denominator));
    const auto high =
        static_cast<std::int32_t>(floor_of_quotient(end.numerator, end.denominator)) + 1;
    if (low < high) out.push_back({low, high});
  }
}

Rows filled_rows(std::span<const Corner> corners, std::int32_t depth) {
  Rows out(static_cast<std::size_t>(depth));
  for (std::size_t i = 0; i < corners.size(); ++i)
    add_line(corners[i], corners[(i + 1) % corners.size()], out);
  std::vector<Crossing> crossings;
  for (std::int32_t z = 0; z < depth; ++z) {
    auto& row = out[static_cast<std::size_t>(z)];
    add_inside(corners, z, crossings, row);
    join_stretches(row);
  }
  return out;
}

/// Returns the columns around which everything within `wall` along both axes is in the rows.
Rows inner_rows(const Rows& rows, std::int32_t wall) {
  Rows narrow = rows;
  for (auto& row : narrow) {
    for (RowStretch& part : row) part = {part.low + wall, part.high - wall};
    std::erase_if(row, [](const RowStretch& part) { return part.low >= part.high; });
  }
  Rows out(rows.size());
  const auto reach = static_cast<std::size_t>(wall);
  for (std::size_t z = reach; z + reach < rows.size(); ++z) {
    out[z] = narrow[z - reach];
    for (std::size_t k = z - reach + 1; k <= z + reach && !out[z].empty(); ++k)
      out[z] = common_stretches(out[z], narrow[k]);
  }
  return out;
}

}  // namespace

Result<PlacedBuild> polygon_build(const Prism& prism, std::span<const VoxelPos> corners,
                                  Material material) {
  RUNSTONE_ASSERT(!corners.empty() && corners.size() <= kPolygonCornersMax);
  RUNSTONE_ASSERT(prism.height > 0 && prism.wall > 0);
  VoxelPos low = corners.front(), high = corners.front();
  for (const VoxelPos& corner : corners) {
    low.x = std::min(low.x, corner.x);
    low.z = std::min(low.z, corner.z);
    high.x = std::max(high.x, corner.x);
    high.z = std::max(high.z, corner.z);
  }
  if (std::max({high.x - low.x, high.z - low.z, prism.height - 1}) >= kSolidSideMax)
    return fail(ErrorCode::limit_exceeded, "the polygon is longer than 1,024 voxels");
  std::vector<Corner> flat;
  for (const VoxelPos& corner : corners) flat.push_back({corner.x - low.x, corner.z - low.z});
  const VoxelPos sides{high.x - low.x + 1, prism.height, high.z - low.z + 1};
  const Rows rows = filled_rows(flat, sides.z);
  Rows inner(rows.size());
  if (prism.fill != SolidFill::solid) inner = inner_rows(rows, prism.wall);
  const std::int32_t lid = prism.fill == SolidFill::hollow ? prism.wall : 0;
  std::vector<RowStretch> left;
  auto build = build_of_rows(sides, Axis::y, material,
                             [&](std::int32_t y, std::int32_t z, std::vector<RowStretch>& out) {
                               const auto row = static_cast<std::size_t>(z);
                               out = rows[row];
                               if (y >= lid && y < prism.height - lid)
                                 subtract_stretches(inner[row], out, left);
                             });
  if (!build) return failure(build.error());
  return PlacedBuild{{low.x, corners.front().y, low.z}, *std::move(build)};
}

}  // namespace runstone
