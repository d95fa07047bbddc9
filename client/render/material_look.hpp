// MaterialLook: how a renderer varies the colour of a material. It is made from the name and the
// number of the material, because the table has only a colour. Pure.
#pragma once
#include <cstdint>

#include "common/materials/material_table.hpp"

namespace runstone {

enum class MaterialPattern : std::uint8_t { none, planks, bricks, liquid };

struct MaterialLook {
  float variation = 0.10F;  // of the brightness from voxel to voxel
  float grain = 0.08F;      // of the brightness within a voxel
  float emission = 0;       // light that the material gives off, as a share of its colour, 0 .. 1
  MaterialPattern pattern = MaterialPattern::none;
};

/// Cost: O(length of the name).
MaterialLook material_look(const MaterialInfo& material);

}  // namespace runstone
