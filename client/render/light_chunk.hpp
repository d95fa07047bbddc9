// LightChunk: the runs of a chunk as runs of light codes. Materials with the same effect on light
// become one run. Pure.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/render/light_code.hpp"
#include "common/runs/run_chunk.hpp"
#include "common/runs/span_boxes.hpp"

namespace runstone {

struct LightChunk {
  RunChunk codes;  // canonical, with a LightCode in place of each material
  /// For each column, at x + edge * z: one more than the y of its highest opaque voxel, 0 if it has
  /// none. Empty if the chunk has only one code.
  std::vector<std::uint8_t> tops;

  /// Requires local coordinates inside the chunk.
  int top(int x, int z) const;
  std::size_t byte_size() const { return codes.runs.byte_capacity() + tops.capacity(); }
};

/// Requires a cube. Cost: O(runs + columns that opaque runs cover).
LightChunk light_chunk(const RunChunk& chunk, const LightCodes& codes);

/// Calls f(first, last, code) for boxes [first, last) that tile the chunk. Places are in voxels
/// from its origin along x, y and z. Cost: O(runs).
template <class F>
void for_each_light_box(const RunChunk& codes, F&& f) {
  const OrderedExtent extent = ordered(codes.extent, codes.order);
  const auto axes = axes_of(codes.order);
  std::uint32_t begin = 0;
  for (std::size_t run = 0; run < codes.runs.size(); ++run) {
    const std::uint32_t end = codes.runs.end(run);
    const LightCode code = codes.runs.material(run);
    for_each_box(extent, begin, end, [&](const OrderedBox& box) {
      std::array<int, 3> first{}, last{};
      for (std::size_t rank = 0; rank < 3; ++rank) {
        first[static_cast<std::size_t>(axes[rank])] = static_cast<int>(box.first[rank]);
        last[static_cast<std::size_t>(axes[rank])] = static_cast<int>(box.last[rank]);
      }
      f(first, last, code);
    });
    begin = end;
  }
}

}  // namespace runstone
