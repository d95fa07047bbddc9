// RunSink: collects the runs of a chunk by their starts. Unlike RunBuilder it keeps its memory, and
// the list that it makes has no spare capacity. Internal to tiles.
#pragma once
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/run_list.hpp"

namespace runstone::tiles {

class RunSink {
 public:
  void clear() { starts_.clear(); }
  /// Sets the material from voxel `first` on. Equal neighbours are merged. Requires ascending
  /// voxels, the first of them 0.
  void append(std::uint32_t first, Material material) {
    if (!starts_.empty() && starts_.back().material == material) return;
    starts_.push_back({first, material});
  }
  /// Returns the canonical runs of `volume` voxels.
  RunList runs_of(std::uint32_t volume) const;

 private:
  struct Start {
    std::uint32_t voxel;
    Material material;
  };
  std::vector<Start> starts_;
};

}  // namespace runstone::tiles
