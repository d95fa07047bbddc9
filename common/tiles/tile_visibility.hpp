// TileVisibility: how materials count in tiles. The cells of a tile are all cubes.
#pragma once
#include <cstdint>
#include <utility>

#include "common/mesh/visibility.hpp"
#include "common/tiles/tile_rules.hpp"

namespace runstone {

struct TileVisibility {
  /// Every material is a cube.
  TileVisibility(const VisibilityTable& cubes)  // NOLINT(google-explicit-constructor)
      : cells(cubes), veil(cubes) {}
  TileVisibility(VisibilityTable of_cells, VisibilityTable of_veil, std::uint32_t rules_number)
      : cells(std::move(of_cells)), veil(std::move(of_veil)), rules(rules_number) {}

  /// For build_tile(): a shape that fills at least half of its voxel counts as a cube, any other
  /// one is empty.
  VisibilityTable cells;
  /// For veiled(): shapes are empty, because a shape hides nothing.
  VisibilityTable veil;
  /// tile_rules_of() the materials. Tiles of one number can be used together.
  std::uint32_t rules = kTileRules;
};

}  // namespace runstone
