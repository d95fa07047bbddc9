// The surface of a material in GLSL: its pattern and its roughness. MaterialTextures packs both
// into the last component of a look: the pattern is the whole part, the roughness the fraction.
#pragma once

namespace runstone {

/// The whole part for a liquid, above all patterns. From 7 on patterns are silhouettes of plants
/// (plant_glsl.hpp).
inline constexpr float kLiquidSurface = 15.0F;
/// The fraction for roughness 1. It is below 1 by more than the step of a 16-bit float below 16.
inline constexpr float kRoughnessScale = 0.98F;
static_assert(kRoughnessScale == 0.98F);  // RUNSTONE_SURFACE_PARTS_GLSL has this number
/// From this roughness on, in percent, a face mirrors nothing (RUNSTONE_GLOSS_GLSL).
inline constexpr int kMattRoughness = 70;

/// float hash(ivec3): a number of a place, -0.5 .. 0.5.
#define RUNSTONE_HASH_GLSL                                                              \
  "float hash(ivec3 p) {\n"                                                             \
  "  uint h = uint(p.x) * 73856093u ^ uint(p.y) * 19349663u ^ uint(p.z) * 83492791u;\n" \
  "  h = (h ^ (h >> 13)) * 1274126177u;\n"                                              \
  "  return float((h >> 16) & 255u) / 255.0 - 0.5;\n"                                   \
  "}\n"

// The next three macros require `look`. RUNSTONE_PATTERN_GLSL requires RUNSTONE_HASH_GLSL, too, and
// RUNSTONE_GLOSS_GLSL requires RUNSTONE_SURFACE_PARTS_GLSL and RUNSTONE_LIGHT_GLSL.
//   shade(): the factor of the brightness at `st`, the place on the face in voxels. `up` is 1 on
//     upper and lower faces. Patterns are those of common/core/material_look.hpp. Bricks are
//     shifted by a half from row to row. The weave has eight threads to a voxel.
//   gloss(): `lit` with the sun and the sky that a smooth face mirrors. `sun` is the share of
//     sunlight on the face, `open` that of skylight. Half of the highlight has the colour of the
//     material, as on metal. A face of roughness 0.7 or more, which a 16-bit float may round down,
//     stays as it is, at the cost of one comparison.
#define RUNSTONE_SURFACE_PARTS_GLSL               \
  "bool is_liquid() { return look.a >= 15.0; }\n" \
  "float roughness() { return min(fract(look.a) / 0.98, 1.0); }\n"

#define RUNSTONE_PATTERN_GLSL                                                         \
  "float joints(vec2 st, float bricks) {\n"                                           \
  "  float row = st.y * 4.0;\n"                                                       \
  "  float along = st.x * 2.0 + 0.5 * bricks * floor(mod(row, 2.0));\n"               \
  "  float between_rows = step(abs(fract(row) - 0.5), 0.42);\n"                       \
  "  float between_bricks = mix(1.0, step(abs(fract(along) - 0.5), 0.46), bricks);\n" \
  "  return 1.0 - 0.35 * (1.0 - between_rows * between_bricks);\n"                    \
  "}\n"                                                                               \
  "float cobble(vec2 st) {\n"                                                         \
  "  float row = floor(st.y * 3.0);\n"                                                \
  "  float shift = 0.8 * hash(ivec3(row, 7, 3)) + 0.5 * mod(row, 2.0);\n"             \
  "  vec2 q = vec2(st.x * 2.5 + shift, st.y * 3.0);\n"                                \
  "  vec2 d = max(abs(fract(q) - 0.5) - 0.2, 0.0);\n"                                 \
  "  float stone = 1.0 + 0.3 * hash(ivec3(floor(q), 5));\n"                           \
  "  return mix(stone, 0.6, smoothstep(0.18, 0.3, length(d)));\n"                     \
  "}\n"                                                                               \
  "float bark(vec2 st, float up) {\n"                                                 \
  "  float ring = length(fract(st) - 0.5) * 7.0;\n"                                   \
  "  float bend = sin(st.y * 5.0 + floor(st.x * 6.0) * 2.0);\n"                       \
  "  float groove = st.x * 6.0 + 0.35 * bend;\n"                                      \
  "  float deep = abs(fract(mix(groove, ring, up)) - 0.5);\n"                         \
  "  return 1.0 - 0.28 * smoothstep(0.25, 0.5, deep);\n"                              \
  "}\n"                                                                               \
  "float shade(vec2 st, float up) {\n"                                                \
  "  if (look.a < 1.0 || look.a >= 7.0) return 1.0;\n"                                \
  "  if (look.a < 3.0) return joints(st, step(2.0, look.a));\n"                       \
  "  vec2 edge = abs(fract(st) - 0.5);\n"                                             \
  "  if (look.a < 4.0) return 1.0 - 0.3 * step(0.465, max(edge.x, edge.y));\n"        \
  "  if (look.a < 5.0) return cobble(st);\n"                                          \
  "  if (look.a < 6.0) return bark(st, up);\n"                                        \
  "  vec2 thread = st * 50.265;\n"                                                    \
  "  return 1.0 + 0.13 * sin(thread.x) * sin(thread.y);\n"                            \
  "}\n"

#define RUNSTONE_GLOSS_GLSL                                                             \
  "vec3 gloss(vec3 lit, vec3 tinted, vec3 n, vec3 relative, float sun, float open) {\n" \
  "  float smoothness = 1.0 - roughness();\n"                                           \
  "  if (smoothness < 0.303) return lit;\n"                                             \
  "  vec3 sight = normalize(relative);\n"                                               \
  "  float spot = max(dot(n, normalize(sun_direction - sight)), 0.0);\n"                \
  "  float shine = smoothness * smoothness;\n"                                          \
  "  float away = 1.0 - max(-dot(sight, n), 0.0);\n"                                    \
  "  float fresnel = shine * (0.06 + 0.5 * away * away * away * away);\n"               \
  "  vec3 mirrored = sky(reflect(sight, n)) * open;\n"                                  \
  "  vec3 sheen = mix(vec3(1.0), tinted, 0.5);\n"                                       \
  "  float bright = sun * shine * pow(spot, 4.0 * exp2(7.0 * smoothness));\n"           \
  "  return mix(lit, mirrored, fresnel) + sun_colour * sheen * bright;\n"               \
  "}\n"

}  // namespace runstone
