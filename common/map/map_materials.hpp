// MapMaterials: the facts about a world's materials that the map from above needs.
#pragma once
#include <vector>

#include "common/core/material_row.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/column_tops.hpp"

namespace runstone {

struct MapMaterials {
  // A shape that fills less than half of its voxel is not drawn (visibility_as_cube()).
  ShowingMaterials showing;             // every material that is drawn
  ShowingMaterials ground;              // every opaque material that is drawn
  std::vector<MaterialColour> colours;  // by id

  /// Returns the colour of a material; magenta if the table lacks it.
  MaterialColour colour(Material id) const {
    return id < colours.size() ? colours[id] : MaterialColour{255, 0, 255, 255};
  }
};

/// Returns the facts about the materials of a table. Cost: O(materials and their boxes).
MapMaterials map_materials(const MaterialTable& table);

}  // namespace runstone
