// RunSink: collects the runs of a chunk by their starts. Unlike RunBuilder it keeps its memory, and
// the list that it makes has no spare capacity.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

class RunSink {
 public:
  void clear() { starts_.clear(); }
  /// Sets the material from voxel `first` on. Equal neighbours are merged. Requires ascending
  /// voxels, the first of them 0.
  void append(std::uint32_t first, Material material) {
    if (!starts_.empty() && starts_.back().material == material) return;
    starts_.push_back({first, material});
  }
  /// Returns true if the collected runs equal `runs`. Requires canonical runs.
  template <class Runs>
  bool holds(const Runs& runs) const {
    if (runs.size() != starts_.size()) return false;
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      const std::uint32_t first = i == 0 ? 0 : runs.end(i - 1);
      if (starts_[i].voxel != first || starts_[i].material != runs.material(i)) return false;
    }
    return true;
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

}  // namespace runstone
