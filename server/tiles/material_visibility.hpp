// The TileVisibility of a table of materials.
#pragma once
#include "common/materials/material_table.hpp"
#include "common/tiles/tile_rules.hpp"
#include "common/tiles/tile_visibility.hpp"

namespace runstone {

/// Returns how tiles see the materials of a table. Cost: O(boxes of the materials).
inline TileVisibility tile_visibility_of(const MaterialTable& materials) {
  return {VisibilityTable(half_filled_visibilities(materials)),
          VisibilityTable(cube_visibilities(materials)),
          tile_rules_of(tile_shapes_number(materials))};
}

}  // namespace runstone
