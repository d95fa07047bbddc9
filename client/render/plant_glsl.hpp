// The silhouettes of plants in GLSL: what the patterns `blades`, `flower` and `foliage` leave of
// the crossed planes of a plant. They are drawn, and cast shadows, if RUNSTONE_HOLES is defined. A
// silhouette has 16 x 16 cells, and differs from column to column of the world.
#pragma once

namespace runstone {

/// For vertex shaders, after RUNSTONE_QUAD_GLSL. Returns the look for a corner: the patterns of
/// plants belong to the planes of plants alone, and everything else has none instead.
#define RUNSTONE_TO_PLANT_GLSL                                   \
  "#ifdef RUNSTONE_HOLES\n"                                      \
  "out vec2 plant_place;\n"                                      \
  "#endif\n"                                                     \
  "vec4 plant_look(QuadCorner c, vec4 look) {\n"                 \
  "  bool is_plant = look.a >= 7.0 && look.a < 15.0;\n"          \
  "  if (is_plant && c.inside != 0.0) look.a = fract(look.a);\n" \
  "#ifdef RUNSTONE_HOLES\n"                                      \
  "  plant_place = c.plane;\n"                                   \
  "#endif\n"                                                     \
  "  return look;\n"                                             \
  "}\n"

/// For fragment shaders. Requires `look`, `voxel` and RUNSTONE_HASH_GLSL. in_silhouette() returns
/// the colour of a pixel of a plant without a picture, and discards the pixels beside its shape.
/// Stalks and leaves are green. The lower part of a plant is darker.
#define RUNSTONE_PLANT_GLSL                                                           \
  "#ifdef RUNSTONE_HOLES\n"                                                           \
  "in vec2 plant_place;\n"                                                            \
  "bool is_blade(ivec2 q, ivec2 at) {\n"                                              \
  "  int lean = (q.y * q.y) >> 6;\n"                                                  \
  "  int blade = q.x + (hash(ivec3(q.x >> 2, at)) > 0.0 ? lean : -lean);\n"           \
  "  return float(q.y) < 6.5 + 17.0 * hash(ivec3(blade, at.yx));\n"                   \
  "}\n"                                                                               \
  "bool is_foliage(ivec2 q, ivec2 at) {\n"                                            \
  "  vec2 d = (vec2(q) - 7.5) / 16.0;\n"                                              \
  "  float ragged = 0.42 + 0.16 * hash(ivec3(q >> 1, at.x ^ at.y));\n"                \
  "  bool is_stalk = q.y < 5 && abs(d.x) < 0.1;\n"                                    \
  "  return is_stalk || (length(d) < ragged && hash(ivec3(q, at.x + at.y)) < 0.3);\n" \
  "}\n"                                                                               \
  "vec4 in_silhouette(vec4 colour) {\n"                                               \
  "  if (look.a < 7.0 || look.a >= 15.0) return colour;\n"                            \
  "  ivec2 q = ivec2(clamp(plant_place * 16.0, 0.0, 15.5));\n"                        \
  "  ivec2 at = ivec2(floor(voxel.xz));\n"                                            \
  "  if (look.a >= 8.0 && look.a < 9.0) {\n"                                          \
  "    vec2 d = vec2(q) - vec2(7.5, 11.5);\n"                                         \
  "    bool is_leaf = q.y < 5 && abs(d.x) < float(q.y) + 0.6;\n"                      \
  "    if (dot(d, d) < 16.0) {\n"                                                     \
  "      if (dot(d, d) < 3.0) colour.rgb *= 0.55;\n"                                  \
  "    } else if (d.y < 0.0 && (abs(d.x) < 1.0 || is_leaf)) {\n"                      \
  "      colour.rgb = vec3(0.13, 0.27, 0.06);\n"                                      \
  "    } else {\n"                                                                    \
  "      discard;\n"                                                                  \
  "    }\n"                                                                           \
  "    return colour;\n"                                                              \
  "  }\n"                                                                             \
  "  if (!(look.a < 8.0 ? is_blade(q, at) : is_foliage(q, at))) discard;\n"           \
  "  colour.rgb *= 0.62 + 0.5 * plant_place.y + 0.2 * hash(ivec3(q, at.x));\n"        \
  "  return colour;\n"                                                                \
  "}\n"                                                                               \
  "#else\n"                                                                           \
  "vec4 in_silhouette(vec4 colour) { return colour; }\n"                              \
  "#endif\n"

}  // namespace runstone
