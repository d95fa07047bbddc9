// CellGrid: the oracle for builds. It is a dense box of cells with loops for each cell. It shares no
// code with common/builds. Each grid that is made counts as a dense expansion; copies do not.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/hash.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone::test {

using GridCell = std::optional<Material>;  // nullopt: untouched

class CellGrid {
 public:
  /// Makes a box of untouched cells. Requires positive sides.
  explicit CellGrid(VoxelPos sides);

  VoxelPos sides() const { return sides_; }
  GridCell at(VoxelPos cell) const { return cells_[slot(cell)]; }
  void set(VoxelPos cell, GridCell value) { cells_[slot(cell)] = value; }
  bool any() const;
  friend bool operator==(const CellGrid&, const CellGrid&) = default;

 private:
  std::size_t slot(VoxelPos c) const {
    return static_cast<std::size_t>(c.x) +
           static_cast<std::size_t>(sides_.x) *
               (static_cast<std::size_t>(c.y) +
                static_cast<std::size_t>(sides_.y) * static_cast<std::size_t>(c.z));
  }
  VoxelPos sides_;
  std::vector<GridCell> cells_;
};

/// Calls f(cell) for each cell of a box of these sides.
template <class F>
void for_each_cell(VoxelPos sides, F&& f) {
  for (VoxelPos c; c.z < sides.z; ++c.z) {
    for (c.y = 0; c.y < sides.y; ++c.y) {
      for (c.x = 0; c.x < sides.x; ++c.x) f(c);
    }
  }
}

/// Returns boxes and single cells of the materials 0 .. materials - 1, with untouched cells between
/// them, and at least one touched cell.
CellGrid random_cells(SplitMix64& rng, VoxelPos sides, unsigned materials);

/// Returns cuts at random distances of 1 to `distance_max`.
BuildCuts random_cuts(SplitMix64& rng, VoxelPos sides, std::int32_t distance_max);

/// Makes the build of a grid cell by cell, in random axis orders.
BuildPtr build_of_cells(SplitMix64& rng, const CellGrid& cells, const BuildCuts& cuts);

/// Reads a build cell by cell.
CellGrid cells_of(const Build& build);

/// Returns how a grid lies in the world, from the definition of orientations in docs/edit-log.md.
CellGrid turned_cells(const CellGrid& cells, const Orientation& orientation);

/// Returns why the build breaks an invariant, or an empty text.
std::string broken_invariant(const Build& build);

}  // namespace runstone::test
