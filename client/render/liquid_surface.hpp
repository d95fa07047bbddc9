// The surface of liquids lies lower than their cubes: kLiquidDrop sixteenths of a voxel
// (common/mesh/shapes/liquid_steps.hpp). The vertex shaders lower it, so quads and their bytes stay
// those of cubes.
#pragma once
#include "client/render/surface_glsl.hpp"
#include "common/mesh/shapes/liquid_steps.hpp"

namespace runstone {

static_assert(kLiquidDrop == 2);         // RUNSTONE_LOWERED_GLSL and RUNSTONE_QUAD_GLSL have 2/16
static_assert(kLiquidSurface == 15.0F);  // RUNSTONE_LOWERED_GLSL and is_liquid() have 15.0

/// How far a vertex lies below the corner of its cube, in world voxels at every level of detail.
/// Requires the colour and the look of the material (material_textures.hpp).
#define RUNSTONE_LOWERED_GLSL                                          \
  "float lowered(QuadCorner c, vec4 colour, vec4 look) {\n"            \
  "  return look.a >= 15.0 && colour.a < 1.0 ? 0.125 * c.top : 0.0;\n" \
  "}\n"

}  // namespace runstone
