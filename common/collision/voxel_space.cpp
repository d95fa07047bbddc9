#include "common/collision/voxel_space.hpp"

#include "common/core/assert.hpp"
#include "common/runs/run_cursor.hpp"

namespace runstone {
namespace {

/// Returns the index of a voxel of the set in [first, last) of the flattened chunk.
template <class Runs>
std::optional<VoxelIndex> found_between(RunCursor<Runs>& cursor, const MaterialSet& materials,
                                        VoxelIndex first, VoxelIndex last) {
  cursor.jump(first);
  for (VoxelIndex at = first;;) {
    if (materials.contains(cursor.material())) return at;
    at = cursor.end();
    if (at >= last) return std::nullopt;
    cursor.next();
  }
}

/// Returns a voxel of the set among those from `min` to `max`, both included.
std::optional<LocalPos> find_in_chunk(const RunChunk& chunk, const MaterialSet& materials,
                                      LocalPos min, LocalPos max) {
  if (chunk.is_uniform()) {
    if (materials.contains(chunk.runs.material(0))) return min;
    return std::nullopt;
  }
  const OrderedExtent extent = ordered(chunk.extent, chunk.order);
  const OrderedPos low = to_ordered(min, chunk.order), high = to_ordered(max, chunk.order);
  return chunk.runs.visit([&](auto runs) -> std::optional<LocalPos> {
    RunCursor cursor(runs);
    for (std::uint32_t s = low.s; s <= high.s; ++s) {
      for (std::uint32_t m = low.m; m <= high.m; ++m) {
        const VoxelIndex line = extent.f * (m + extent.m * s);
        if (const auto at = found_between(cursor, materials, line + low.f, line + high.f + 1))
          return pos_of(*at, chunk.extent, chunk.order);
      }
    }
    return std::nullopt;
  });
}

}  // namespace

std::optional<VoxelPos> find_voxel(const VoxelSpace& space, const MaterialSet& materials,
                                   const VoxelBox& box) {
  if (box.empty()) return std::nullopt;
  const std::int32_t edge = space.edge();
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  ChunkCoord at;
  for (at.x = first.x; at.x <= last.x; ++at.x) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.z = first.z; at.z <= last.z; ++at.z) {
        const VoxelBox part = intersect(box, box_of(at, edge));
        const RunChunk* chunk = space.chunk(at);
        if (chunk == nullptr) {
          if (materials.has_unknown()) return part.min;
          continue;
        }
        RUNSTONE_DASSERT(chunk->extent == Extent::cube(static_cast<unsigned>(edge)));
        const LocalPos max = local_of({part.max.x - 1, part.max.y - 1, part.max.z - 1}, edge);
        if (const auto found = find_in_chunk(*chunk, materials, local_of(part.min, edge), max)) {
          const VoxelPos origin = origin_of(at, edge);
          return VoxelPos{origin.x + found->x, origin.y + found->y, origin.z + found->z};
        }
      }
    }
  }
  return std::nullopt;
}

}  // namespace runstone
