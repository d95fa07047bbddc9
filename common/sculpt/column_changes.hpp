// ColumnChanges: the voxels that a brush changes, as runs along y, and the build that pastes
// exactly them. Voxels that keep their material are not among them, so a paste does not overwrite
// later edits of other players there.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/builds/build.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/sculpt/ground_columns.hpp"
#include "common/sculpt/ground_surface.hpp"

namespace runstone {

/// The voxels [low, high) of a column become this material.
struct ColumnChange {
  std::size_t column = 0;  // GroundColumns::index()
  std::int32_t low = 0, high = 0;
  Material material = kEmpty;
  friend bool operator==(const ColumnChange&, const ColumnChange&) = default;
};

/// Changes by column, ascending, and from below to above in a column.
using ColumnChanges = std::vector<ColumnChange>;

/// The voxels of the ground that belong to its surface: grass and the soil below it. They move with
/// the height of a column.
inline constexpr std::int32_t kSkinVoxels = 4;

/// Appends the changes that move the surface of a column from one height to another, as
/// surface_heights() gives them. The upper kSkinVoxels voxels of ground move with the surface, and
/// so does a plant of one voxel on it. Where the ground rises, the material below the skin fills
/// the gap; only empty voxels and liquids are filled. Where it sinks, ground becomes empty, or the
/// liquid that stands on it. Heights are cut to those for which the box has room. Cost: O(runs +
/// voxels between the heights).
void move_surface(const GroundColumns& columns, std::size_t column, std::int32_t from,
                  std::int32_t to, const GroundMaterials& materials, ColumnChanges& out);

/// Appends the changes that set the upper voxels of the ground of a column to `layers`, the highest
/// first, as deep as ground lies without a gap. Cost: O(log runs * layers).
void set_layers(const GroundColumns& columns, std::size_t column, std::int32_t surface,
                std::span<const Material> layers, const GroundMaterials& materials,
                ColumnChanges& out);

/// A build and its corner in the world.
struct PlacedBuild {
  VoxelPos at;
  BuildPtr build;  // null: nothing changes
};

/// Returns the changes as a build, whose other cells are untouched. Fails with limit_exceeded if it
/// takes more than kBuildBytesMax. Cost: O(changes + columns of the box that holds them).
Result<PlacedBuild> build_of_changes(const GroundColumns& columns, const ColumnChanges& changes);

}  // namespace runstone
