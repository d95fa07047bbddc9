// The surface of liquids lies lower than their cubes: kLiquidDrop sixteenths of a voxel
// (common/mesh/shapes/liquid_steps.hpp). The vertex shaders lower it, so quads and their bytes stay
// those of cubes.
#pragma once
#include "client/render/surface_glsl.hpp"
#include "common/materials/material_table.hpp"
#include "common/mesh/shapes/liquid_steps.hpp"

namespace runstone {

/// Returns true for the liquids whose surface lies lower: the transparent ones. An opaque one hides
/// the faces of its neighbours, which a lower surface would show.
inline bool has_lowered_surface(const MaterialInfo& row) {
  return row.body == MaterialBody::liquid && row.visibility == Visibility::transparent &&
         row.colour[3] < 255 && row.shape.is_cube();
}

static_assert(kLiquidDrop == 2);         // RUNSTONE_LOWERED_GLSL and RUNSTONE_QUAD_GLSL have 2/16
static_assert(kLiquidSurface == 15.0F);  // RUNSTONE_LOWERED_GLSL and is_liquid() have 15.0

/// How far a vertex lies below the corner of its cube, in world voxels at every level of detail.
/// Requires the colour and the look of the material (material_textures.hpp).
#define RUNSTONE_LOWERED_GLSL                                          \
  "float lowered(QuadCorner c, vec4 colour, vec4 look) {\n"            \
  "  return look.a >= 15.0 && colour.a < 1.0 ? 0.125 * c.top : 0.0;\n" \
  "}\n"

}  // namespace runstone
