// Few voxels: the voxels of one chunk that selected edits may change, where they are few. A plan of
// their number then needs no chunk: single voxels are followed through the log (voxel_restore.hpp).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "common/generate/generator.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

/// Returns the voxels of `inside` that the selected records may change, strictly ascending: those of
/// their bounding boxes. Returns nullopt if they are so many, or if so many of the records are large
/// edits, that the whole chunk costs less. `records` are those of the chunk, ascending, `selected`
/// ascend, and `edge` is that of the chunk. Cost: O(records + voxels log voxels).
std::optional<std::vector<VoxelPos>> few_voxels(std::span<const EditRecord* const> records,
                                                std::span<const Sequence> selected,
                                                const VoxelBox& inside, std::int32_t edge);

/// Returns the materials of these voxels of a chunk before the log that is added to it: those of
/// `stored`, or of the generator if that is nullopt.
std::vector<Material> materials_of(std::span<const VoxelPos> voxels,
                                   const std::optional<Chunk>& stored, const Generator& generator,
                                   const ChunkKey& key, std::int32_t edge);

}  // namespace runstone
