// CornerGrid: a set of points of the lattice of one region: one bit each, 269 KB.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mesh/quad_corners.hpp"
#include "common/runs/extent.hpp"

namespace runstone {

/// The points of a region along an axis: both ends count.
inline constexpr std::size_t kRegionPoints = kSideMax + 1;

class CornerGrid {
 public:
  CornerGrid() : bits_(kRegionPoints * kRegionPoints * kRegionPoints / 64 + 1) {}

  void clear() { std::fill(bits_.begin(), bits_.end(), std::uint64_t{0}); }
  bool has(const Corner& at) const {
    const std::size_t i = index(at);
    return (bits_[i / 64] >> (i % 64) & 1) != 0;
  }
  /// Adds a point. Returns false if it was in the set.
  bool add(const Corner& at) {
    const std::size_t i = index(at);
    const std::uint64_t bit = std::uint64_t{1} << (i % 64);
    if ((bits_[i / 64] & bit) != 0) return false;
    bits_[i / 64] |= bit;
    return true;
  }

 private:
  static std::size_t index(const Corner& at) {
    return static_cast<std::size_t>(at[0]) +
           kRegionPoints * (static_cast<std::size_t>(at[1]) +
                            kRegionPoints * static_cast<std::size_t>(at[2]));
  }
  std::vector<std::uint64_t> bits_;
};

}  // namespace runstone
