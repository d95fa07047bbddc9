// LandMaterials: the materials of a landscape, by name.
#pragma once
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

struct LandMaterials {
  Material grass, forest_floor, dirt, stone, sand, gravel, clay, snow, water;
  Material log, leaves, birch_log, birch_leaves, pine_leaves;
  Material tall_grass, fern, bush, reeds, poppy, dandelion, cornflower;

  /// Fails with not_found if the table lacks one of them.
  static Result<LandMaterials> find(const MaterialTable& table);
};

}  // namespace runstone
