// Lookback: compares each voxel of a flattened chunk with the voxel a fixed number of places before
// it, stretch by stretch: its neighbour along the middle or the slowest axis.
#pragma once
#include <algorithm>
#include <cstdint>

#include "common/runs/run_cursor.hpp"

namespace runstone {

/// Two cursors over the same runs, which compare each voxel with the voxel `behind` places before
/// it.
template <class Runs>
class Lookback {
 public:
  Lookback(Runs runs, std::uint32_t behind) : lead_(runs), lag_(runs), behind_(behind) {}

  /// Calls differs(i, j, material) for the stretches [i, j) of [from, to) whose material differs
  /// from the material `behind` places earlier. Requires behind <= from, and calls in ascending
  /// order.
  template <class F>
  void compare(std::uint32_t from, std::uint32_t to, F&& differs) {
    if (from >= to) return;
    lead_.seek(from);
    lag_.seek(from - behind_);
    for (std::uint32_t i = from;;) {
      const std::uint32_t lead_end = lead_.end();
      const std::uint32_t lag_end = lag_.end() + behind_;
      const std::uint32_t stop = std::min({lead_end, lag_end, to});
      if (lead_.material() != lag_.material()) differs(i, stop, lead_.material());
      if (stop == to) return;
      i = stop;
      if (lead_end == stop) lead_.next();
      if (lag_end == stop) lag_.next();
    }
  }

 private:
  RunCursor<Runs> lead_, lag_;
  std::uint32_t behind_;
};

}  // namespace runstone
