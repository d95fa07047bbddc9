// Export of a box of the world as a Luanti world.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "server/history/build_at.hpp"
#include "server/history/world_at.hpp"
#include "server/replay/luanti_world_writer.hpp"

namespace runstone {

/// Returns why a box cannot be written as a Luanti world, or an empty text.
std::string luanti_box_refusal(const VoxelBox& box);

/// Writes the voxels of a box of a world, at their places, as blocks of Luanti. Voxels outside the
/// box are air, and blocks of air are left out. Nodes are those of luanti_node_of(). Returns
/// the number of voxels that are not empty. Requires a box that luanti_box_refusal() accepts. Fails
/// with one line if the world cannot be read, the block cannot be written, or `progress` returns
/// false. Memory: a chunk. Cost: that of WorldAt::voxels() for each chunk, and O(voxels of the
/// blocks). Blocks on the disk.
Result<std::uint64_t, std::string> export_luanti(const WorldAt& world, WorldReader& reader,
                                                 const MaterialTable& materials,
                                                 const VoxelBox& box, std::int32_t chunk_edge,
                                                 LuantiWorldWriter& writer,
                                                 const ChunkProgress& progress);

}  // namespace runstone
