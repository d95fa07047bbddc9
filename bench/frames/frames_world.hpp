// FramesWorld: the chunks of one picture. A block of chunks is drawn with nothing around it, as the
// thesis profiled its scenarios. Faces towards a chunk of the block are culled; those on the
// block's sides are not.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "bench/worlds/voxel_world.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

struct FramesChunk {
  ChunkCoord at;  // the lowest corner of the block is 0 0 0
  Volume volume;
};

struct FramesWorld {
  std::string name;
  unsigned edge = 0;
  std::array<int, 3> size{};  // chunks along x, y, z
  std::shared_ptr<const VisibilityTable> visibility;
  std::vector<FramesChunk> chunks;
  std::shared_ptr<const MaterialTable> materials = nullptr;  // null: only their visibility is known
};

/// Returns "scenario_1" .. "scenario_37", then "luanti".
std::vector<std::string> frames_world_names();

/// Returns a block of `size` chunks whose lowest voxel is `origin`. Cost: O(volume).
FramesWorld block_of(const VoxelWorld& world, VoxelPos origin, std::array<int, 3> size,
                     unsigned edge);

/// Returns the world of that name at edge 32: a scenario's 3 x 3 x 3 chunks, or of the Luanti world
/// in `luanti` the 5 x 3 x 5 chunks around the ground in its middle, or as many as fit its bounds.
/// Requires a name of the list. Fails with the importer's message.
Result<FramesWorld, std::string> frames_world(const std::string& name, const std::string& luanti);

}  // namespace runstone::bench
