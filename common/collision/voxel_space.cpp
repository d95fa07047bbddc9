#include "common/collision/voxel_space.hpp"

#include <algorithm>

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

/// Calls visit(first index, end, material) for the parts of runs of the set among the voxels from
/// `min` to `max`, both included.
template <class Visit>
void visit_in_chunk(const RunChunk& chunk, const MaterialSet& materials, LocalPos min, LocalPos max,
                    const Visit& visit) {
  const OrderedExtent extent = ordered(chunk.extent, chunk.order);
  const OrderedPos low = to_ordered(min, chunk.order), high = to_ordered(max, chunk.order);
  chunk.runs.visit([&](auto runs) {
    RunCursor cursor(runs);
    for (std::uint32_t s = low.s; s <= high.s; ++s) {
      for (std::uint32_t m = low.m; m <= high.m; ++m) {
        const VoxelIndex line = extent.f * (m + extent.m * s), last = line + high.f + 1;
        cursor.jump(line + low.f);
        for (VoxelIndex at = line + low.f; at < last; at = cursor.end(), cursor.next()) {
          if (materials.contains(cursor.material()))
            visit(at, std::min<VoxelIndex>(cursor.end(), last), cursor.material());
          if (cursor.end() >= last) break;
        }
      }
    }
  });
}

/// Calls visit(chunk, its coordinate, part of the box in it) for each chunk that the box touches,
/// until it returns false. The chunk is null if it is not known.
template <class Visit>
void visit_chunks(const VoxelSpace& space, const VoxelBox& box, const Visit& visit) {
  if (box.empty()) return;
  const std::int32_t edge = space.edge();
  const ChunkCoord first = chunk_of(box.min, edge);
  const ChunkCoord last = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  ChunkCoord at;
  for (at.x = first.x; at.x <= last.x; ++at.x) {
    for (at.y = first.y; at.y <= last.y; ++at.y) {
      for (at.z = first.z; at.z <= last.z; ++at.z) {
        const RunChunk* chunk = space.chunk(at);
        RUNSTONE_DASSERT(chunk == nullptr ||
                         chunk->extent == Extent::cube(static_cast<unsigned>(edge)));
        if (!visit(chunk, at, intersect(box, box_of(at, edge)))) return;
      }
    }
  }
}

LocalPos last_of(const VoxelBox& box, std::int32_t edge) {
  return local_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
}

VoxelPos world_pos_of(ChunkCoord at, LocalPos local, std::int32_t edge) {
  const VoxelPos origin = origin_of(at, edge);
  return {origin.x + local.x, origin.y + local.y, origin.z + local.z};
}

}  // namespace

std::optional<VoxelPos> find_voxel(const VoxelSpace& space, const MaterialSet& materials,
                                   const VoxelBox& box) {
  const std::int32_t edge = space.edge();
  std::optional<VoxelPos> out;
  visit_chunks(space, box, [&](const RunChunk* chunk, ChunkCoord at, const VoxelBox& part) {
    if (chunk == nullptr) {
      if (materials.has_unknown()) out = part.min;
    } else if (const auto found = find_in_chunk(*chunk, materials, local_of(part.min, edge),
                                                last_of(part, edge))) {
      out = world_pos_of(at, *found, edge);
    }
    return !out;
  });
  return out;
}

void visit_voxels(const VoxelSpace& space, const MaterialSet& materials, const VoxelBox& box,
                  const std::function<void(VoxelPos, Material)>& visit) {
  const std::int32_t edge = space.edge();
  visit_chunks(space, box, [&](const RunChunk* chunk, ChunkCoord at, const VoxelBox& part) {
    if (chunk == nullptr) return true;
    visit_in_chunk(*chunk, materials, local_of(part.min, edge), last_of(part, edge),
                   [&](VoxelIndex from, VoxelIndex end, Material material) {
                     for (VoxelIndex i = from; i < end; ++i)
                       visit(world_pos_of(at, pos_of(i, chunk->extent, chunk->order), edge),
                             material);
                   });
    return true;
  });
}

}  // namespace runstone
