// The partition oracle finds the fewest rectangles that tile a region of equal faces, without the
// tested algorithm. For small regions it tries all partitions. For any region it counts corners,
// chords and holes.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "tests/reference/face_plane.hpp"
#include "tests/reference/independent_set.hpp"

namespace runstone::test {

/// Regions of a grid of `width` x `height` as bits, row after row.
class LeastRectangles {
 public:
  /// Requires width * height <= 64. Above 36 it takes too long.
  LeastRectangles(unsigned width, unsigned height) : width_(width), height_(height) {}
  /// Returns the fewest rectangles that cover each cell of a region once. Tries all rectangles that
  /// contain the first cell, and solves the rest of each. Keeps results.
  unsigned of(std::uint64_t region);

 private:
  unsigned width_, height_;
  std::unordered_map<std::uint64_t, unsigned> known_;
};

/// Returns the sum over all materials of a plane by the formula: concave corners, minus the most
/// chords that neither cross nor touch, minus holes, plus one, for each component. Counts
/// everything cell by cell. Cost: O(chords^2).
std::size_t least_rectangles_by_formula(const reference::FacePlane& plane);

/// Returns the edges of the largest matching of a bipartite graph, by one augmenting path after the
/// other.
std::size_t matching_size(const reference::BipartiteGraph& graph);

/// Returns the fault of rectangles as a partition of a plane, or an empty text: a cell left out or
/// covered twice, or a material that differs from the cells'.
std::string partition_fault(const reference::FacePlane& plane,
                            const std::vector<reference::PlaneRectangle>& rectangles);

}  // namespace runstone::test
