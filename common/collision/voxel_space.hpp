// VoxelSpace: the chunks that the queries of this folder read, wherever they are kept. find_voxel()
// is the box query on which all other queries are built. It reads runs: along each line of the box
// it looks up one run and walks from there, so no voxel is unpacked.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>

#include "common/collision/material_set.hpp"
#include "common/core/coords.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

class VoxelSpace {
 public:
  /// `edge` is the edge of the chunks in voxels.
  explicit VoxelSpace(std::int32_t edge) : edge_(edge) {}
  virtual ~VoxelSpace() = default;
  std::int32_t edge() const { return edge_; }
  /// Returns the voxels of a chunk, a cube of edge(), or null if they are not known. The pointer is
  /// valid until the next call.
  virtual const RunChunk* chunk(ChunkCoord at) const = 0;

 private:
  std::int32_t edge_;
};

/// Returns a voxel of `box` whose material is in the set, or nullopt if there is none. An empty box
/// has no voxel. Requires a box within the world.
/// Cost: O(lines * log runs + runs met), where a line is a row of the box along the fastest axis of
/// its chunk.
std::optional<VoxelPos> find_voxel(const VoxelSpace& space, const MaterialSet& materials,
                                   const VoxelBox& box);

/// Calls visit(voxel, material) for each voxel of `box` whose material is in the set. Chunks that
/// are not known have none. Requires a box within the world. Cost: that of find_voxel(), and one
/// call for each voxel found.
void visit_voxels(const VoxelSpace& space, const MaterialSet& materials, const VoxelBox& box,
                  const std::function<void(VoxelPos, Material)>& visit);

}  // namespace runstone
