// SweepPoints: the corners of one region in the order of a sweep.
#pragma once
#include <cstdint>
#include <vector>

#include "tests/reference/outlines.hpp"

namespace runstone::reference {

/// A point is a place, and a corner is one passage of a ring through it. Where a region touches
/// itself, a point has two corners.
struct SweepPoints {
  struct Corner {
    std::uint32_t point = 0;  // index in `points`
    // Its neighbours along the ring, as indices in `corners`.
    std::uint32_t before = 0, after = 0;
  };
  std::vector<LayerPoint> points;  // each once, ascending
  std::vector<Corner> corners;     // ascending by point

  /// Reads the corners of a region. Cost: O(corners log corners).
  void read(const Outlines& outlines, const Outlines::Region& region);

 private:
  // Corner of the outlines by rank, and rank by corner.
  std::vector<std::uint32_t> order_, rank_;
};

}  // namespace runstone::reference
