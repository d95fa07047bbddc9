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

/// With more voxels, the whole chunk costs less.
inline constexpr std::size_t kFewVoxelsMax = 1'024;

/// Returns the voxels of `inside` that the selected records may change, strictly ascending: those of
/// their bounding boxes. Returns nullopt if they are too many, or if the log has so many large edits
/// that the whole chunk costs less. `records` are those of the chunk, ascending, and `selected`
/// ascend. Cost: O(records + voxels log voxels).
std::optional<std::vector<VoxelPos>> few_voxels(std::span<const EditRecord* const> records,
                                                std::span<const Sequence> selected,
                                                const VoxelBox& inside);

/// Returns the materials of these voxels of a chunk before the log that is added to it: those of
/// `stored`, or of the generator if that is nullopt.
std::vector<Material> materials_of(std::span<const VoxelPos> voxels,
                                   const std::optional<Chunk>& stored, const Generator& generator,
                                   const ChunkKey& key, std::int32_t edge);

}  // namespace runstone
