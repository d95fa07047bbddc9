#include "common/sculpt/wand.hpp"

#include <algorithm>
#include <cstddef>

#include "common/runs/reorder.hpp"

namespace runstone {
namespace {

bool finds(const WandSearch& search, Material material) {
  return search.material ? material == *search.material : material != kEmpty;
}

/// Adds the voxels of a chunk in the order xyz that lie in the box. Returns their number.
std::uint64_t add_found(const WandSearch& search, const RunChunk& chunk, VoxelPos origin,
                        const VoxelBox& box, VoxelRows& out) {
  const auto edge = static_cast<std::uint32_t>(chunk.extent.x);
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
    if (!finds(search, chunk.runs.material(i))) continue;
    const std::uint32_t end = chunk.runs.end(i);
    for (std::uint32_t at = chunk.runs.begin(i); at < end;) {
      const std::uint32_t line = at / edge, last = std::min(end, (line + 1) * edge);
      const std::int32_t y = origin.y + static_cast<std::int32_t>(line % edge),
                         z = origin.z + static_cast<std::int32_t>(line / edge);
      const std::int32_t start = origin.x - static_cast<std::int32_t>(line * edge);
      const RowStretch part{std::max(box.min.x, start + static_cast<std::int32_t>(at)),
                            std::min(box.max.x, start + static_cast<std::int32_t>(last))};
      if (part.low < part.high && y >= box.min.y && y < box.max.y && z >= box.min.z &&
          z < box.max.z) {
        out.add(y, z, part);
        count += static_cast<std::uint64_t>(part.high - part.low);
      }
      at = last;
    }
  }
  return count;
}

}  // namespace

Result<VoxelRows, FloodFault> connected_voxels(const WandSearch& search, VoxelPos start,
                                               std::int32_t edge, const ChunkLookup& chunk_at) {
  const auto part_of = [&](Material material) {
    return finds(search, material) ? FloodPart::taken : FloodPart::stops;
  };
  FloodLimits limits;
  limits.voxels_max = search.voxels_max;
  LineFlood flood(edge, chunk_at, part_of, limits);
  if (const auto fault = flood.run(start)) return failure(*fault);
  VoxelRows out;
  const auto side = static_cast<std::size_t>(edge);
  for (const auto& [at, lines] : flood.chunks()) {
    const VoxelPos origin = origin_of(at, edge);
    for (std::size_t line = 0; line < side * side; ++line) {
      for (std::uint32_t i = lines.begins[line]; i < lines.begins[line + 1]; ++i) {
        const LineFlood::Stretch& part = lines.stretches[i];
        if (!part.is_reached) continue;
        out.add(origin.y + static_cast<std::int32_t>(line % side),
                origin.z + static_cast<std::int32_t>(line / side),
                {origin.x + part.first, origin.x + part.last});
      }
    }
  }
  out.join();
  return out;
}

Result<VoxelRows, FloodFault> voxels_of_boxes(const WandSearch& search,
                                              std::span<const VoxelBox> boxes, std::int32_t edge,
                                              const ChunkLookup& chunk_at) {
  VoxelRows out;
  std::uint64_t count = 0;
  for (const VoxelBox& box : boxes) {
    const ChunkCoord first = chunk_of(box.min, edge);
    const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
    for (ChunkCoord at = first; at.z <= last.z; ++at.z) {
      for (at.y = first.y; at.y <= last.y; ++at.y) {
        for (at.x = first.x; at.x <= last.x; ++at.x) {
          const auto chunk = chunk_at(at);
          if (!chunk) return failure(FloodFault::missing_chunk);
          const VoxelPos origin = origin_of(at, edge);
          count += chunk->order == AxisOrder::xyz
                       ? add_found(search, *chunk, origin, box, out)
                       : add_found(search, reorder(*chunk, AxisOrder::xyz), origin, box, out);
          if (count > search.voxels_max) return failure(FloodFault::too_many_voxels);
        }
      }
    }
  }
  if (out.empty()) return failure(FloodFault::blocked);
  out.join();
  return out;
}

}  // namespace runstone
