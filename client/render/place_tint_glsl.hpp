// The tint of natural ground by its place, in GLSL, so that grass is not one green. It depends on
// the coordinates of the voxel alone.
#pragma once

namespace runstone {

/// vec3 by_place(): the factor of the colour at `voxel`. It goes from cool and dark to warm and
/// bright in spots of 16 to 128 voxels. Requires `look`, `voxel` and NoiseTexture::bind(). `scale`
/// is the side of a voxel: in tiles the spots are where they are in chunks.
///
/// Natural is a material whose grain is above 12 %, without light of its own, and without a pattern
/// or with that of a plant: grass, leaves, moss, earth and gravel fully, stone and sand a little.
/// Built materials have patterns, or less grain, and keep their colour.
///
/// Near ground needs no mipmaps, which cost time where the processor draws. The noise repeats after
/// 2,048 voxels, which divides the 8,192 after which `voxel` does.
#define RUNSTONE_PLACE_TINT_GLSL                                                  \
  "uniform sampler2D noise;\n"                                                    \
  "uniform float scale;\n"                                                        \
  "vec3 by_place() {\n"                                                           \
  "  bool has_pattern = look.a >= 1.0 && (look.a < 7.0 || look.a >= 15.0);\n"     \
  "  float natural = !has_pattern && look.b == 0.0 ? 5.0 * look.g - 0.6 : 0.0;\n" \
  "#ifdef RUNSTONE_TILE\n"                                                        \
  "  float spot = texture(noise, voxel.xz * (scale / 2048.0)).g - 0.5;\n"         \
  "#else\n"                                                                       \
  "  float spot = textureLod(noise, voxel.xz * (scale / 2048.0), 0.0).g - 0.5;\n" \
  "#endif\n"                                                                      \
  "  return 1.0 + (spot * clamp(natural, 0.0, 1.0)) * vec3(0.95, 0.42, -0.25);\n" \
  "}\n"

}  // namespace runstone
