#include "common/builds/widened.hpp"

#include <algorithm>
#include <array>

#include "common/runs/run_builder.hpp"

namespace runstone {
namespace {

std::array<std::int32_t, 3> sides_of(VoxelPos at) { return {at.x, at.y, at.z}; }

}  // namespace

RunChunk widened(const RunChunk& cells, const VoxelBox& part, const VoxelBox& box) {
  if (part == box) return cells;
  const auto axes = axes_of(cells.order);
  const auto min = sides_of(part.min), max = sides_of(part.max);
  const auto low = sides_of(box.min), high = sides_of(box.max);
  std::array<std::uint32_t, 3> before{}, inside{}, behind{};
  for (std::size_t rank = 0; rank < 3; ++rank) {
    const std::size_t i = static_cast<std::size_t>(axes[rank]);
    before[rank] = static_cast<std::uint32_t>(min[i] - low[i]);
    inside[rank] = static_cast<std::uint32_t>(max[i] - min[i]);
    behind[rank] = static_cast<std::uint32_t>(high[i] - max[i]);
  }
  const Extent extent{static_cast<std::uint8_t>(high[0] - low[0]),
                      static_cast<std::uint8_t>(high[1] - low[1]),
                      static_cast<std::uint8_t>(high[2] - low[2])};
  const std::uint32_t line = before[0] + inside[0] + behind[0];
  const std::uint32_t layer = line * (before[1] + inside[1] + behind[1]);
  RunBuilder out(extent, cells.order);
  out.append(before[2] * layer, 0);
  std::size_t run = 0;
  std::uint32_t at = 0;
  for (std::uint32_t s = 0; s < inside[2]; ++s) {
    out.append(before[1] * line, 0);
    for (std::uint32_t m = 0; m < inside[1]; ++m) {
      out.append(before[0], 0);
      for (std::uint32_t left = inside[0]; left != 0;) {
        const Run part_run = cells.runs[run];
        const std::uint32_t count = std::min(left, part_run.end - at);
        out.append(count, part_run.material);
        at += count;
        left -= count;
        if (at == part_run.end) ++run;
      }
      out.append(behind[0], 0);
    }
    out.append(behind[1] * line, 0);
  }
  out.append(behind[2] * layer, 0);
  return out.finish();
}

}  // namespace runstone
