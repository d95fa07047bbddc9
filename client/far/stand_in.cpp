#include "client/far/stand_in.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "common/runs/cut.hpp"
#include "common/runs/run_builder.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {

RunChunk cut_octant(const RunChunk& tile, unsigned octant) {
  RUNSTONE_ASSERT(octant < 8 && tile.extent.x % 2 == 0);
  const unsigned half = tile.extent.x / 2U;
  const auto from = [&](unsigned bit) {
    return static_cast<std::uint8_t>((octant >> bit & 1U) * half);
  };
  return cut(tile, {from(0), from(1), from(2)}, Extent::cube(half));
}

RunChunk stand_in(const RunChunk& parent, unsigned octant) {
  const RunChunk part = cut_octant(parent, octant);
  const unsigned half = part.extent.x;
  if (part.is_uniform())
    return uniform_chunk(parent.extent, material_at(part, {0, 0, 0}), parent.order);
  RunBuilder out(parent.extent, parent.order);
  using Stretch = std::pair<std::uint32_t, Material>;
  std::vector<Stretch> line, layer;
  const auto append = [&out](const std::vector<Stretch>& stretches) {
    for (const auto& [count, material] : stretches) out.append(count, material);
  };
  part.runs.visit([&](const auto& runs) {
    RunCursor cursor(runs);
    std::uint32_t at = 0;
    for (unsigned s = 0; s < half; ++s) {
      layer.clear();
      for (unsigned m = 0; m < half; ++m) {
        line.clear();
        for (const std::uint32_t end = at + half; at < end;) {
          const std::uint32_t stop = std::min(cursor.end(), end);
          line.emplace_back(2 * (stop - at), cursor.material());
          at = stop;
          if (at == cursor.end() && !cursor.last()) cursor.next();
        }
        for (int twice = 0; twice < 2; ++twice) layer.insert(layer.end(), line.begin(), line.end());
      }
      for (int twice = 0; twice < 2; ++twice) append(layer);
    }
  });
  return out.finish();
}

}  // namespace runstone
