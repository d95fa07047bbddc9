// VoxelWorld: voxels to measure on, known column by column, so that any volume of any edge can be cut from
// them as runs. Formulas and foreign worlds look alike to the benchmarks.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/mesh_scene.hpp"

namespace runstone::bench {

struct VoxelWorld {
  std::string name;
  std::shared_ptr<const VisibilityTable> visibility;
  /// What is known of it: voxels outside count as empty, and a chunk without any inside is missing. None:
  /// everything is.
  std::optional<VoxelBox> bounds;
  /// Writes the voxels (at.x, at.y + i, at.z). Requires them inside the bounds, and at most kSideMax.
  std::function<void(VoxelPos at, std::span<Material> out)> column;
};

/// A cube of the world in its cheapest axis order. O(volume).
RunChunk chunk_of_world(const VoxelWorld& world, VoxelPos origin, unsigned edge);

/// A chunk with its six neighbours, each in its cheapest order.
struct Volume {
  VoxelPos origin;
  unsigned edge = 0;
  test::MeshScene scene;
};
Volume cut_volume(const VoxelWorld& world, VoxelPos origin, unsigned edge);

/// All volumes that fit side by side into a box, from its lowest corner on. Where they do not fill a side of
/// it, a last one lies flush with the upper corner and overlaps the one before, so that every voxel is in
/// one. None in a box that is narrower than one.
std::vector<Volume> volumes_in(const VoxelWorld& world, const VoxelBox& box, unsigned edge);

/// Those of a world's bounds, upper margins included, without the ones of a single material; of an endless world the volume around
/// the origin.
std::vector<Volume> volumes_of(const VoxelWorld& world, unsigned edge);

}  // namespace runstone::bench
