// The scene of a .vox: where its models are. Internal to the reader of .vox.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "common/core/result.hpp"
#include "common/formats/vox_file.hpp"

namespace runstone {

/// A model in the scene: its voxel v covers floor(turn * (v + 1/2 - floor(sides / 2)) + shift), in the
/// axes of the file.
struct PlacedVoxModel {
  std::size_t model = 0;
  VoxPlace place;
};

/// Returns the place of the same point in the parent's parent. Fails with nullopt if it is outside the
/// world. `inner` is the place of the child in the parent.
std::optional<VoxPlace> composed(const VoxPlace& outer, const VoxPlace& inner);

/// Returns the models that show, in the order of the scene. Fails if nodes form a cycle, name nodes or
/// models that do not exist, place models outside the world, or if the scene visits more than
/// kVoxNodesMax nodes, those below several parents counted once for each. Cost: O(nodes visited).
Result<std::vector<PlacedVoxModel>> placed_models(const VoxFile& file);

}  // namespace runstone
