// Veil: replaces the materials of enclosed voxels of a tile, so that its runs are long. Tiles are
// never edited, so no face of an enclosed voxel is seen in the world. The client also draws
// octants, whose sides show enclosed voxels, so it veils each tile itself
// (client/far/far_planner.hpp). Servers veil tiles for the wire. They make tiles of tiles without a
// veil, because a voxel that is enclosed in one level may be seen in the next.
//
// The rule: an opaque voxel whose six neighbours are all opaque takes the material of its
// predecessor in index order, after that one was veiled. Voxels on the border of the tile keep
// their material, because the voxels beyond it are not known. No face that is drawn changes, with
// any neighbours of the tile.
#pragma once
#include <memory>
#include <optional>

#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The buffers that calls reuse. A scratch belongs to one thread, and callers do not use its
/// contents.
class VeilScratch {
 public:
  VeilScratch();
  ~VeilScratch();
  VeilScratch(VeilScratch&&) noexcept;
  VeilScratch& operator=(VeilScratch&&) noexcept;
  struct State;
  State& state() { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

/// Returns the tile with its veil, in the same axis order, or nullopt if the veil changes no voxel.
/// The result never has more runs than the tile. The veil of a veiled tile changes nothing.
/// Requires a valid tile of any extent. Thread: any, with one scratch each. In a steady state only
/// the result allocates. Cost: O(lines + runs).
std::optional<RunChunk> veiled(const RunChunk& tile, const VisibilityTable& visibility,
                               VeilScratch& scratch);

}  // namespace runstone
