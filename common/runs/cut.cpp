#include "common/runs/cut.hpp"

#include <algorithm>
#include <utility>

#include "common/runs/run_builder.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

template <class Runs>
void append_forward(RunCursor<Runs>& cursor, VoxelIndex first, VoxelIndex last, RunBuilder& out) {
  for (VoxelIndex at = first; at < last;) {
    const VoxelIndex stop = std::min(cursor.end(), last);
    out.append(stop - at, cursor.material());
    at = stop;
    if (at < last) cursor.next();
  }
}

// Requires `run` to be the run of voxel last - 1.
template <class Runs>
void append_backward(const Runs& runs, std::size_t run, VoxelIndex first, VoxelIndex last,
                     RunBuilder& out) {
  for (VoxelIndex stop = last; stop > first; --run) {
    const VoxelIndex begin = run == 0 ? 0 : runs.end(run - 1);
    const VoxelIndex at = std::max(begin, first);
    out.append(stop - at, runs.material(run));
    stop = at;
  }
}

}  // namespace

RunChunk cut(const RunChunk& chunk, LocalPos first, Extent extent, std::uint8_t mirrored) {
  RUNSTONE_ASSERT(first.x + extent.x <= chunk.extent.x && first.y + extent.y <= chunk.extent.y &&
                  first.z + extent.z <= chunk.extent.z);
  RunBuilder out(extent, chunk.order);
  const auto axes = axes_of(chunk.order);
  const auto turned = [&](std::size_t rank) {
    return (mirrored >> static_cast<unsigned>(axes[rank]) & 1U) != 0;
  };
  const bool turn_f = turned(0), turn_m = turned(1), turn_s = turned(2);
  const OrderedExtent e = ordered(chunk.extent, chunk.order);
  const OrderedExtent part = ordered(extent, chunk.order);
  const OrderedPos from = to_ordered(first, chunk.order);
  // Consecutive whole lines are one stretch, and so are consecutive whole layers.
  std::uint32_t stretch = part.f, lines = part.m, layers = part.s;
  if (part.f == e.f && !turn_f && !turn_m) {
    stretch *= std::exchange(lines, 1U);
    if (part.m == e.m && !turn_s) stretch *= std::exchange(layers, 1U);
  }
  chunk.runs.visit([&]<class Runs>(const Runs& runs) {
    RunCursor<Runs> cursor(runs);
    for (std::uint32_t i = 0; i < layers; ++i) {
      const std::uint32_t s = from.s + (turn_s ? layers - 1 - i : i);
      for (std::uint32_t j = 0; j < lines; ++j) {
        const std::uint32_t m = from.m + (turn_m ? lines - 1 - j : j);
        const VoxelIndex begin = from.f + e.f * (m + e.m * s);
        if (turn_f) {
          cursor.jump(begin + stretch - 1);
          append_backward(runs, cursor.run(), begin, begin + stretch, out);
          continue;
        }
        if (turn_m || turn_s) {
          cursor.jump(begin);
        } else {
          cursor.seek(begin);
        }
        append_forward(cursor, begin, begin + stretch, out);
      }
    }
  });
  return out.finish();
}

}  // namespace runstone
