#include "server/interest/view_cells.hpp"

#include <algorithm>

namespace runstone {
namespace {

struct Heights {  // half-open
  std::int64_t low = 0, high = 0;
};

Heights heights_of(const View& view) {
  return {std::int64_t{view.centre.y} - view.radius_v,
          std::int64_t{view.centre.y} + view.radius_v + 1};
}

bool has_column(const View& view, std::int64_t x, std::int64_t z) {
  const std::int64_t dx = x - view.centre.x;
  const std::int64_t dz = z - view.centre.z;
  return dx * dx + dz * dz <= std::int64_t{view.radius_h} * view.radius_h;
}

}  // namespace

void append_difference(const View& view, const std::optional<View>& other, CoordLimit limit,
                       std::vector<ChunkCoord>& out) {
  const auto append = [&](std::int64_t x, std::int64_t z, Heights range) {
    range.low = std::max<std::int64_t>(range.low, -limit.limit);
    range.high = std::min<std::int64_t>(range.high, limit.limit);
    for (std::int64_t y = range.low; y < range.high; ++y) {
      out.push_back({static_cast<std::int32_t>(x), static_cast<std::int32_t>(y),
                     static_cast<std::int32_t>(z)});
    }
  };
  const Heights mine = heights_of(view);
  const std::int64_t radius = view.radius_h;
  for (std::int64_t x = view.centre.x - radius; x <= view.centre.x + radius; ++x) {
    if (x < -limit.limit || x >= limit.limit) continue;
    for (std::int64_t z = view.centre.z - radius; z <= view.centre.z + radius; ++z) {
      if (z < -limit.limit || z >= limit.limit || !has_column(view, x, z)) continue;
      if (!other || !has_column(*other, x, z)) {
        append(x, z, mine);
        continue;
      }
      const Heights theirs = heights_of(*other);
      append(x, z, {mine.low, std::min(mine.high, theirs.low)});
      append(x, z, {std::max(mine.low, theirs.high), mine.high});
    }
  }
}

}  // namespace runstone
