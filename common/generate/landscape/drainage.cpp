#include "common/generate/landscape/drainage.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "common/core/hash.hpp"
#include "common/core/integer_root.hpp"

namespace runstone {
namespace {

constexpr std::size_t kSquaresKept = 2048;
constexpr int kReachNodes = 2;  // nodes farther away have no effect on a square
constexpr int kFlowSteps = 6;   // the nodes that drain into a river in so many steps give its width
constexpr int kFlowMargin = kReachNodes + 1 + kFlowSteps;  // ends of edges are one node farther
constexpr int kNodeMargin = kFlowMargin + 1;
constexpr int kNodeSide = 2 * kNodeMargin + 1;
constexpr std::int32_t kSpawnLand = 5120;  // voxels around the origin that are rather land than sea

constexpr std::int32_t kRangeLand = 150;  // no range where continent() is not above it

constexpr int node_index(int i, int k) { return i + kNodeMargin + kNodeSide * (k + kNodeMargin); }

}  // namespace

WatercoursePoint nearest_point(const Watercourse& course, std::int32_t x, std::int32_t z) {
  const std::int64_t dx = x - course.x, dz = z - course.z;
  const std::int64_t along = dx * course.to_x + dz * course.to_z;
  // `along` has at most 36 bits. With 8 of them gone, the product fits 64 bits for each length that
  // two nodes can have.
  const std::int64_t scaled = ((along >> 8) * course.inverse) >> 24;
  const auto t = static_cast<std::int32_t>(std::clamp<std::int64_t>(scaled, 0, kOne));
  const std::int64_t off_x = dx - ((std::int64_t{course.to_x} * t) >> 12);
  const std::int64_t off_z = dz - ((std::int64_t{course.to_z} * t) >> 12);
  const std::int32_t fall = std::clamp(
      static_cast<std::int32_t>((std::int64_t{t - course.plateau} * course.plateau_inverse) >> 12),
      0, kOne);
  return {off_x * off_x + off_z * off_z,
          course.half_width + times(course.to_half_width - course.half_width, t),
          course.level * 256 + times((course.to_level - course.level) * 256, fall)};
}

Drainage::Drainage(std::uint64_t seed)
    : key_(mix64(seed)),
      continent_14_(key_ ^ 1, 14),
      continent_13_(key_ ^ 2, 13),
      continent_12_(key_ ^ 3, 12),
      continent_11_(key_ ^ 4, 11),
      range_13_(key_ ^ 5, 13),
      range_12_(key_ ^ 6, 12),
      ranges_14_(key_ ^ 7, 14),
      squares_(kSquaresKept) {}

std::shared_ptr<const DrainageSquare> Drainage::square(std::int32_t x, std::int32_t z) const {
  return squares_.get({x, z}, [&] { return make(x, z); });
}

std::int32_t Drainage::continent(std::int32_t x, std::int32_t z) const {
  std::int32_t out = continent_14_.at(x, z) / 2 + continent_13_.at(x, z) * 3 / 8 +
                     continent_12_.at(x, z) / 4 + continent_11_.at(x, z) / 8;
  out += 280;
  // Players arrive near the origin, so there is land.
  if (std::abs(x) < kSpawnLand && std::abs(z) < kSpawnLand) {
    const std::int32_t near_x =
        kOne - static_cast<std::int32_t>(std::int64_t{x} * x * kOne / kSpawnLand / kSpawnLand);
    const std::int32_t near_z =
        kOne - static_cast<std::int32_t>(std::int64_t{z} * z * kOne / kSpawnLand / kSpawnLand);
    out += times(times(near_x, near_x), times(near_z, near_z)) / 3;
  }
  return out;
}

std::int32_t Drainage::mountain_share(std::int32_t x, std::int32_t z) const {
  return mountain_share(x, z, continent(x, z));
}

std::int32_t Drainage::mountain_share(std::int32_t x, std::int32_t z, std::int32_t land) const {
  if (land <= kRangeLand) return 0;
  // A range follows the line where its noise is zero, in the regions that have ranges.
  const std::int32_t line = range_13_.at(x, z) * 3 / 4 + range_12_.at(x, z) / 2;
  const std::int32_t crest = kOne - std::min(kOne, std::abs(line) * 7 / 4);
  const std::int32_t region = ramp(ranges_14_.at(x, z), -2500, 0);
  const std::int32_t inland = ramp(land, kRangeLand, 900);
  return times(times(fade_of(crest), region), inland);
}

Drainage::Node Drainage::node(std::int32_t i, std::int32_t k) const {
  Node out;
  out.random = place_hash(key_, i, k);
  const auto quarter = [&](unsigned shift) {  // the middle half of the square
    return kDrainageWidth / 4 +
           static_cast<std::int32_t>((out.random >> shift) % (kDrainageWidth / 2));
  };
  out.x = i * kDrainageWidth + quarter(0);
  out.z = k * kDrainageWidth + quarter(12);
  const std::int32_t land = continent(out.x, out.z);
  const std::int32_t mountain = mountain_share(out.x, out.z, land);
  const auto share = static_cast<std::int32_t>((out.random >> 24) & (kOne - 1));
  if (land <= 0) {
    out.level = -4 - std::min(56, -land * 56 / 1600);
  } else {
    out.level = 2 + std::min(land, 2400) * 44 / 2400 + times(mountain, 60) +
                times(times(mountain, mountain), 190) + times(6 + times(mountain, 26), share);
  }
  return out;
}

DrainageSquare Drainage::make(std::int32_t x, std::int32_t z) const {
  std::array<Node, kNodeSide * kNodeSide> nodes;
  for (int k = -kNodeMargin; k <= kNodeMargin; ++k) {
    for (int i = -kNodeMargin; i <= kNodeMargin; ++i)
      nodes[static_cast<std::size_t>(node_index(i, k))] = node(x + i, z + k);
  }
  const auto at = [&](int index) -> const Node& { return nodes[static_cast<std::size_t>(index)]; };
  // A node drains into the lowest of its eight neighbours. The number breaks ties.
  std::array<int, kNodeSide * kNodeSide> into;
  into.fill(-1);
  const auto is_lower = [&](int a, int b) {
    return at(a).level != at(b).level ? at(a).level < at(b).level : at(a).random < at(b).random;
  };
  for (int k = -kFlowMargin; k <= kFlowMargin; ++k) {
    for (int i = -kFlowMargin; i <= kFlowMargin; ++i) {
      int lowest = node_index(i, k);
      for (int dk = -1; dk <= 1; ++dk) {
        for (int di = -1; di <= 1; ++di) {
          if (is_lower(node_index(i + di, k + dk), lowest)) lowest = node_index(i + di, k + dk);
        }
      }
      into[static_cast<std::size_t>(node_index(i, k))] = lowest == node_index(i, k) ? -1 : lowest;
    }
  }
  // flow: the nodes whose water passes a node on its first kFlowSteps edges. The bound makes it a
  // property of the node, equal for each square that is computed.
  std::array<int, kNodeSide * kNodeSide> flow, next;
  flow.fill(1);
  for (int step = 0; step < kFlowSteps; ++step) {
    next.fill(1);
    for (std::size_t from = 0; from < into.size(); ++from) {
      if (into[from] >= 0) next[static_cast<std::size_t>(into[from])] += flow[from];
    }
    flow = next;
  }

  DrainageSquare out;
  const auto local_x = [&](const Node& n) { return (n.x - x * kDrainageWidth) * 16; };
  const auto local_z = [&](const Node& n) { return (n.z - z * kDrainageWidth) * 16; };
  /// Returns the radius of the lake around a node, or 0.
  const auto lake = [&](int index) -> std::int32_t {
    const Node& n = at(index);
    const bool is_sink = into[static_cast<std::size_t>(index)] < 0;
    if (n.level < 4 || (!is_sink && (n.random >> 40) % 7 != 0)) return 0;
    return (45 + static_cast<std::int32_t>((n.random >> 44) % 110)) * 16;
  };
  const auto half_width = [&](int index) -> std::int32_t {
    const int water = flow[static_cast<std::size_t>(index)];
    return std::min(14 * 16, 16 + 20 * static_cast<std::int32_t>(integer_root(water * 4)));
  };
  for (int k = -kReachNodes; k <= kReachNodes; ++k) {
    for (int i = -kReachNodes; i <= kReachNodes; ++i) {
      const int from = node_index(i, k), to = into[static_cast<std::size_t>(from)];
      const Node& a = at(from);
      const std::int32_t radius = lake(from);
      if (radius > 0 || to < 0) {
        const bool is_wet = radius > 0;
        out.push_back({local_x(a), local_z(a), 0, 0, 0, a.level, a.level, 0, 0, radius, radius,
                       is_wet, is_wet});
      }
      if (to < 0) continue;
      const Node& b = at(to);
      const std::int64_t dx = (b.x - a.x) * 16, dz = (b.z - a.z) * 16;
      const std::int64_t squared = dx * dx + dz * dz;
      const std::int64_t length = integer_root(squared);
      const auto share = [&](std::int32_t r) {
        return static_cast<std::int32_t>(std::int64_t{r} * kOne / length);
      };
      // Inside a lake the river has the level of the lake.
      const std::int32_t before = share(radius), after = share(lake(to));
      const std::int32_t fall = std::max(64, kOne - before - after);
      const bool is_wet = flow[static_cast<std::size_t>(from)] > 1 && a.level > 0;
      const std::int32_t width = is_wet ? half_width(from) : 0;
      out.push_back({local_x(a), local_z(a), static_cast<std::int32_t>(dx),
                     static_cast<std::int32_t>(dz), (std::int64_t{1} << 44) / squared, a.level,
                     b.level, before, kOne * kOne / fall, width, is_wet ? half_width(to) : 0,
                     is_wet, false});
    }
  }
  return out;
}

}  // namespace runstone
