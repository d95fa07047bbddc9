#include "tests/reference/sweep_points.hpp"

#include <algorithm>
#include <numeric>
#include <span>

namespace runstone::reference {

void SweepPoints::read(const Outlines& outlines, const Outlines::Region& region) {
  const auto rings = std::span(outlines.rings).subspan(region.first_ring, region.ring_count);
  // The rings of a region follow each other.
  const std::uint32_t first = rings.front().first;
  const std::uint32_t count = rings.back().first + rings.back().count - first;
  const LayerPoint* const at = outlines.points.data() + first;

  order_.resize(count);
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(), [at](std::uint32_t a, std::uint32_t b) {
    return at[a] == at[b] ? a < b : at[a] < at[b];
  });
  rank_.resize(count);
  points.clear();
  corners.resize(count);
  for (std::uint32_t rank = 0; rank < count; ++rank) {
    const LayerPoint point = at[order_[rank]];
    rank_[order_[rank]] = rank;
    if (points.empty() || !(points.back() == point)) points.push_back(point);
    corners[rank].point = static_cast<std::uint32_t>(points.size() - 1);
  }
  for (const Outlines::Ring& ring : rings) {
    const std::uint32_t begin = ring.first - first;
    for (std::uint32_t i = 0; i < ring.count; ++i) {
      const std::uint32_t here = rank_[begin + i];
      const std::uint32_t after = rank_[begin + (i + 1) % ring.count];
      corners[here].after = after;
      corners[after].before = here;
    }
  }
}

}  // namespace runstone::reference
