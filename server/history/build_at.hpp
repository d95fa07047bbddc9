// build_at: a box of the world at a moment, as a build with the names of its materials.
#pragma once
#include <cstddef>
#include <functional>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/formats/rsb_build.hpp"
#include "common/generate/generator.hpp"
#include "server/history/world_at.hpp"

namespace runstone {

/// Takes how many chunks of the box are read, and how many there are. Returns false to stop.
using ChunkProgress = std::function<bool(std::uint64_t done, std::uint64_t total)>;

/// Reads a box of the world of `world`, whose generator and materials are given. Every cell is
/// touched; empty voxels have the material "air". The build has no name, and its origin is the
/// lowest corner of the box. Fails with one line if the world cannot be read, if the box is empty,
/// does not lie in the world or is longer than a build may be, if the build takes more than
/// `bytes_max` of memory, or if `progress` returns false. Cost: that of WorldAt::voxels() for each
/// chunk. Blocks on the disk.
Result<FileBuild, std::string> build_at(const WorldAt& world, WorldReader& reader,
                                        const MaterialTable& materials, const VoxelBox& box,
                                        std::int32_t chunk_edge, std::size_t bytes_max,
                                        const ChunkProgress& progress);

}  // namespace runstone
