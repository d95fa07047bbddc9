// Tile rules: what all tiles of this program have in common: the number of the rules by which they
// are made, and their axis order. The rules are build_tile(), veiled(), and the coarse forms of the
// generators. Clients keep tiles over connections and servers keep them on disk. The number tells
// them whether the tiles are still what these rules give.
#pragma once
#include <cstdint>

#include "common/runs/axis_order.hpp"

namespace runstone {

/// Raise it with each change of the rules. A golden test pins tiles of it. Never 0.
inline constexpr std::uint32_t kTileRules = 2;

/// The axis order of tiles: layers lie flat, as most ground does. A veil depends on the order, so
/// all tiles have the same one. Then a tile depends on the voxels of its children alone, and not on
/// the orders in which somebody holds them. docs/tiles.md compares the orders.
inline constexpr AxisOrder kTileOrder = AxisOrder::zxy;

}  // namespace runstone
