// A Luanti world to measure on. It is imported once and kept dense, so that volumes of any edge can
// be cut at any place. Memory: 2 bytes a voxel of its bounds, which must stay below 2^28 voxels.
#pragma once
#include <string>

#include "bench/worlds/voxel_world.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// yes: plants, torches and similar nodes are voxels. no: they are empty, as in an import by
/// default.
enum class PlantsKept : bool { no, yes };

/// Reads `folder`/map.sqlite. The world's name is "luanti". Fails with the importer's message, or
/// if the world is empty or too large.
Result<VoxelWorld, std::string> luanti_world(const std::string& folder,
                                             PlantsKept plants = PlantsKept::no);

}  // namespace runstone::bench
