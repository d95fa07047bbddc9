// SweepPoints: the corners of one region in the order in which a sweep meets them.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/reference/outlines.hpp"

namespace runstone::reference {

/// Corners are passages of a ring, points are places: where a region touches itself a point has two corners.
struct SweepPoints {
  struct Corner {
    std::uint32_t point = 0;              // place in `points`
    std::uint32_t before = 0, after = 0;  // its neighbours along the ring, as places in `corners`
  };
  std::vector<LayerPoint> points;  // each once, ascending
  std::vector<Corner> corners;     // ascending by point

  /// Takes the corners of a region. O(corners log corners).
  void read(const Outlines& outlines, const Outlines::Region& region);

 private:
  std::vector<std::uint32_t> order_, rank_;  // corner of the outlines by rank, and back
};

}  // namespace runstone::reference
