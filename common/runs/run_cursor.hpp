// RunCursor: walks a chunk's runs forward. Reading voxel by voxel or stretch by stretch costs O(1)
// amortised.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "common/core/assert.hpp"
#include "common/runs/run_list.hpp"

namespace runstone {

/// Runs is NarrowRuns or WideRuns (see RunList::visit).
template <class Runs>
class RunCursor {
 public:
  explicit RunCursor(Runs runs) : runs_(runs) {}

  std::size_t run() const { return run_; }
  Material material() const { return runs_.material(run_); }
  std::uint32_t end() const { return runs_.end(run_); }
  bool last() const { return run_ + 1 == runs_.size(); }
  /// Advances to the next run. Requires !last().
  void next() {
    RUNSTONE_DASSERT(!last());
    ++run_;
  }
  /// Moves forward to the run that covers `voxel`. Requires a voxel that is not before the current
  /// run and lies below the volume. Gallops, then bisects. Cost: O(log distance).
  void seek(std::uint32_t voxel) {
    std::size_t step = 1;
    std::size_t low = run_;
    while (low + step < runs_.size() && runs_.end(low + step - 1) <= voxel) {
      low += step;
      step *= 2;
    }
    // Either run low + step - 1 ends behind the voxel, or the search reached the end of the list
    // and the last run does.
    std::size_t high = std::min(low + step, runs_.size()) - 1;
    while (low < high) {
      const std::size_t mid = low + (high - low) / 2;
      if (runs_.end(mid) <= voxel) {
        low = mid + 1;
      } else {
        high = mid;
      }
    }
    run_ = low;
  }

  /// Moves forward or back to the run that covers `voxel`. Requires voxel below the volume. It
  /// bisects without an unpredictable branch and is cheaper than seek() over long distances. Cost:
  /// O(log runs).
  void jump(std::uint32_t voxel) {
    std::size_t low = 0;
    for (std::size_t count = runs_.size(); count > 1;) {
      const std::size_t half = count / 2;
      low += half * static_cast<std::size_t>(runs_.end(low + half - 1) <= voxel);
      count -= half;
    }
    run_ = low;
  }

 private:
  Runs runs_;
  std::size_t run_ = 0;
};

}  // namespace runstone
