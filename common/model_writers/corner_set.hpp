// CornerSet: the corners of the quads of one region, at which edges are split. Those of cubes are
// points of the lattice. Those of shapes may lie between them; they are kept in sorted lists, one
// for each axis, so that the points of a line follow each other.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/shape.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/model_writers/corner_grid.hpp"

namespace runstone {

/// The units of a place along the side of a voxel.
inline constexpr int kModelUnits = kShapeUnits;

/// All places are in sixteenths of a voxel from the lowest corner of the region.
class CornerSet {
 public:
  void clear();
  enum class Added : std::uint8_t { on_lattice, off_lattice, known };
  /// Adds a place. Returns `known` for one of the lattice that was added before.
  Added add(const Corner& at);
  /// Sorts the places off the lattice. Call it after the last add() and before what follows.
  void finish();

  /// Replaces `out` by the distances from `from` of all places that lie strictly between two ends,
  /// ascending. Requires ends that differ along exactly one axis. Cost: O(length in voxels), and
  /// O(log places + found) for those off the lattice.
  void distances_between(const Corner& from, const Corner& to, std::vector<int>& out) const;
  /// Calls f(place) for each place off the lattice, each once, in a fixed order.
  template <class F>
  void for_each_fine(F&& f) const {
    for (const std::uint64_t key : lines_[0]) f(Corner{part(key, 0), part(key, 1), part(key, 2)});
  }

 private:
  // A key has the place along the axis of its list in the low bits, then those along the next two
  // axes.
  static constexpr unsigned kKeyBits = 12;
  static std::uint64_t key_of(const Corner& at, std::size_t axis);
  static int part(std::uint64_t key, unsigned i) {
    return static_cast<int>(key >> (i * kKeyBits) & ((1U << kKeyBits) - 1));
  }

  CornerGrid lattice_;
  std::array<std::vector<std::uint64_t>, 3> lines_;  // by axis
};

}  // namespace runstone
