// BoxIndex: finds the boxes that overlap a given one. It is an R-tree whose nodes are packed by
// Sort-Tile-Recursive (Leutenegger, Edgington, Lopez 1997), and a short list of the boxes that were
// added since it was packed.
// Threads: one writer or several readers.
#pragma once
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {

class BoxIndex {
 public:
  using Id = std::uint32_t;

  /// Requires that the index has no such id. Cost: O(1), and O(n log n) for one of every
  /// max(64, n / 16) changes.
  void insert(Id id, const VoxelBox& box);
  /// Requires that the index has the id. Cost: as insert().
  void remove(Id id);

  /// Calls visit(id) for each box that has a voxel in common with `box`, in no special order, until
  /// visit() returns false. Cost: O(log n + found), if few boxes overlap one another.
  template <class F>
  void visit_overlapping(const VoxelBox& box, F&& visit) const;

  std::size_t size() const;

 private:
  // The data is the implementer's choice.
};

}  // namespace runstone
