// TileVisibility: how materials count in tiles. The cells of a tile are all cubes.
#pragma once
#include <utility>

#include "common/mesh/visibility.hpp"

namespace runstone {

struct TileVisibility {
  /// Every material is a cube.
  TileVisibility(const VisibilityTable& cubes)  // NOLINT(google-explicit-constructor)
      : cells(cubes), veil(cubes) {}
  TileVisibility(VisibilityTable of_cells, VisibilityTable of_veil)
      : cells(std::move(of_cells)), veil(std::move(of_veil)) {}

  /// For build_tile(): a shape that fills at least half of its voxel counts as a cube, any other
  /// one is empty.
  VisibilityTable cells;
  /// For veiled(): shapes are empty, because a shape hides nothing.
  VisibilityTable veil;
};

}  // namespace runstone
