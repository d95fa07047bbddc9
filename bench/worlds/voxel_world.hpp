// VoxelWorld: voxels to measure on, read column by column, so that any volume of any edge can be
// cut from them as runs. Formulas and imported worlds have this one interface.
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
#include "common/materials/material_table.hpp"
#include "common/mesh/visibility.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::bench {

struct VoxelWorld {
  std::string name;
  std::shared_ptr<const VisibilityTable> visibility;
  /// The known part of the world, or nullopt if all of it is known. Voxels outside count as empty,
  /// and a chunk without any voxel inside is missing.
  std::optional<VoxelBox> bounds;
  /// Writes the voxels (at.x, at.y + i, at.z). Requires voxels inside the bounds, and at most
  /// kSideMax of them.
  std::function<void(VoxelPos at, std::span<Material> out)> column;
  std::shared_ptr<const MaterialTable> materials;  // null: only their visibility is known
};

/// Returns a cube of the world in its cheapest axis order. Cost: O(volume).
RunChunk chunk_of_world(const VoxelWorld& world, VoxelPos origin, unsigned edge);

/// A chunk with its six neighbours, each in its cheapest order.
struct Volume {
  VoxelPos origin;
  unsigned edge = 0;
  test::MeshScene scene;
};
Volume cut_volume(const VoxelWorld& world, VoxelPos origin, unsigned edge);

/// Returns all volumes that fit side by side into a box, from its lowest corner on. Where they do
/// not fill a side of the box, a last one lies flush with the upper corner and overlaps the one
/// before, so that every voxel is in a volume. Returns none if the box is narrower than a volume.
std::vector<Volume> volumes_in(const VoxelWorld& world, const VoxelBox& box, unsigned edge);

/// Returns the volumes of a world's bounds, upper margins included, without those of a single
/// material. Returns the volume around the origin if the world is endless.
std::vector<Volume> volumes_of(const VoxelWorld& world, unsigned edge);

}  // namespace runstone::bench
