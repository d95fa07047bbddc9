// Ball: the voxels that a round brush covers, by the rule of the product's spheres: |d|² <= r² + r.
#pragma once
#include <algorithm>
#include <array>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/core/coords.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone::bench::storage {

class Ball {
 public:
  static constexpr std::int32_t kRadiusMax = 15;

  /// Requires 0 <= radius <= kRadiusMax. Callers leave out the parts outside a chunk.
  Ball(LocalPos centre, std::int32_t radius)
      : centre_(centre), radius_(radius), reach_(radius * radius + radius) {
    RUNSTONE_ASSERT(radius >= 0 && radius <= kRadiusMax);
    std::int32_t half = radius;
    for (std::int32_t beside = 0; beside <= reach_; ++beside) {
      while (half * half + beside > reach_) --half;
      half_[static_cast<std::size_t>(beside)] = static_cast<std::uint8_t>(half);
    }
  }

  bool contains(std::int32_t x, std::int32_t y, std::int32_t z) const {
    const std::int32_t dx = x - centre_.x, dy = y - centre_.y, dz = z - centre_.z;
    return dx * dx + dy * dy + dz * dz <= reach_;
  }

  /// Calls row(first, count) for its rows along the fastest axis inside a chunk, in index order.
  template <class F>
  void for_each_row(Extent extent, AxisOrder order, F&& row) const {
    const OrderedExtent e = ordered(extent, order);
    const OrderedPos c = to_ordered(centre_, order);
    const auto first = [&](std::uint32_t at, std::int32_t half) {
      return static_cast<std::uint32_t>(std::max(static_cast<std::int32_t>(at) - half, 0));
    };
    const auto last = [](std::uint32_t at, std::int32_t half, std::uint32_t side) {
      return std::min(at + static_cast<std::uint32_t>(half) + 1, side);
    };
    for (std::uint32_t s = first(c.s, radius_); s < last(c.s, radius_, e.s); ++s) {
      for (std::uint32_t m = first(c.m, radius_); m < last(c.m, radius_, e.m); ++m) {
        const auto ds = static_cast<std::int32_t>(s) - static_cast<std::int32_t>(c.s);
        const auto dm = static_cast<std::int32_t>(m) - static_cast<std::int32_t>(c.m);
        if (ds * ds + dm * dm > reach_) continue;
        const std::int32_t half = half_[static_cast<std::size_t>(ds * ds + dm * dm)];
        const std::uint32_t from = first(c.f, half);
        row(OrderedPos{from, m, s}, last(c.f, half, e.f) - from);
      }
    }
  }

  /// The position of the ball relative to a cube of voxels.
  enum class Against : std::uint8_t { apart, cuts, covers };
  Against against(LocalPos low, std::int32_t side) const {
    std::int32_t nearest = 0, farthest = 0;
    const auto add = [&](std::int32_t centre, std::int32_t first) {
      const std::int32_t before = first - centre, behind = centre - (first + side - 1);
      const std::int32_t near = std::max({before, behind, 0});
      const std::int32_t far = std::max(-before, -behind);
      nearest += near * near;
      farthest += far * far;
    };
    add(centre_.x, low.x);
    add(centre_.y, low.y);
    add(centre_.z, low.z);
    return nearest > reach_ ? Against::apart : farthest <= reach_ ? Against::covers : Against::cuts;
  }

 private:
  LocalPos centre_;
  std::int32_t radius_;
  std::int32_t reach_;  // the largest squared distance inside
  // The reach of a row to either side, by the squared distance of the row from the centre.
  std::array<std::uint8_t, kRadiusMax*(kRadiusMax + 1) + 1> half_{};
};

}  // namespace runstone::bench::storage
