// Trees of a landscape. A tree is its kind, its height and a hash. Its crown is given as the
// interval of heights that it covers in a column, so it becomes runs without a grid.
#pragma once
#include <cstdint>
#include <optional>

#include "common/generate/landscape/land_materials.hpp"

namespace runstone {

/// Crowns reach this many columns from the trunk.
inline constexpr std::int32_t kTreeReach = 4;
/// A tree is less than this many voxels high.
inline constexpr std::int32_t kTreeHeightMax = 24;
/// Each square of this width has at most one tree.
inline constexpr std::int32_t kTreeSpacing = 7;

enum class TreeKind : std::uint8_t { oak, birch, pine, shrub };

struct Tree {
  TreeKind kind;
  std::uint64_t random;
};

/// A stretch of a tree's column, in voxels above the ground at the trunk.
struct TreeStretch {
  std::int32_t from, to;
};

/// Returns the heights that the crown covers in the column that is (dx, dz) from the trunk.
std::optional<TreeStretch> crown_at(const Tree& tree, std::int32_t dx, std::int32_t dz);
/// Returns the height of the trunk.
std::int32_t trunk_height(const Tree& tree);
Material trunk_of(TreeKind kind, const LandMaterials& materials);
Material leaves_of(TreeKind kind, const LandMaterials& materials);

}  // namespace runstone
