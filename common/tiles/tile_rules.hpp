// Tile rules: what all tiles of a world have in common: the number of the rules by which they are
// made, and their axis order. The rules are build_tile(), veiled(), the coarse forms of the
// generators, and the shapes of the materials of the world. Clients keep tiles over connections and
// servers keep them on disk. The number tells them whether the tiles are still what these rules
// give.
#pragma once
#include <cstdint>

#include "common/core/hash.hpp"
#include "common/runs/axis_order.hpp"

namespace runstone {

/// The rules of this program. Raise it with each change of the rules. A golden test pins tiles of
/// it. Never 0.
inline constexpr std::uint32_t kTileRules = 2;

/// Returns the number of the rules of a world. `shapes` is tile_shapes_number() of its materials: a
/// material that gets a shape counts in another way, so the tiles of its voxels change although no
/// voxel does. Returns kTileRules if all materials are cubes, and never 0.
constexpr std::uint32_t tile_rules_of(std::uint64_t shapes) {
  if (shapes == 0) return kTileRules;
  // The highest bit is set, so that no later kTileRules is this number.
  return static_cast<std::uint32_t>(mix64(shapes ^ kTileRules)) | 0x8000'0000U;
}

/// The axis order of tiles: layers lie flat, as most ground does. A veil depends on the order, so
/// all tiles have the same one. Then a tile depends on the voxels of its children alone, and not on
/// the orders in which somebody holds them. docs/tiles.md compares the orders.
inline constexpr AxisOrder kTileOrder = AxisOrder::zxy;

}  // namespace runstone
