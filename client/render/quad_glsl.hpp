// The packed quads of common/mesh/quad.hpp in GLSL: a vertex shader reads quad and corner by the
// number of the vertex, four vertices a quad. So a draw needs no vertex attributes, and the quads
// of all chunks lie in one texture. OpenGL adds the first vertex of a draw to that number; OpenGL
// ES 3.0 cannot, so there it is a uniform. The rectangle of a quad that is a face of a shape lies
// in a second texture (shape_texture.hpp).
#pragma once
#include "client/render/shape_texture.hpp"
#include "client/render/texel_store.hpp"

namespace runstone {

/// The corners of a quad stand in the order 0: (0, 0), 1: (1, 0), 2: (0, 1), 3: (1, 1) along u and
/// v; a negative face reverses u, so that it has the opposite winding. `inside` is the depth below
/// the corner, in voxels, in which the quad's voxel lies. The planes of plants are lit from above,
/// and lie in their voxel with depth 0. Otherwise the lower edge of a plane would be taken for the
/// voxel below. `side` is the direction. `across` is the corner, but on such a plane its z goes
/// from one side of the voxel to the other, and `plane` is the corner on it, 0 .. 1. `top` is 1 at
/// the upper corners of upper and lateral faces of cubes, and 0 elsewhere. A step of a liquid
/// (kLiquidStepFace) is the upper part of a lateral face.
#define RUNSTONE_QUAD_GLSL                                                             \
  RUNSTONE_TEXEL_GLSL                                                                  \
  "uniform usampler2D quads, shapes;\n"                                                \
  "#ifdef GL_ES\n"                                                                     \
  "uniform int first_vertex;\n"                                                        \
  "#else\n"                                                                            \
  "const int first_vertex = 0;\n"                                                      \
  "#endif\n"                                                                           \
  "struct QuadCorner {\n"                                                              \
  "  vec3 at, normal, outward, across;\n"                                              \
  "  vec2 plane;\n"                                                                    \
  "  uint material, side;\n"                                                           \
  "  bool is_shape;\n"                                                                 \
  "  float inside, top;\n"                                                             \
  "};\n"                                                                               \
  "QuadCorner quad_corner() {\n"                                                       \
  "  int number = first_vertex + gl_VertexID;\n"                                       \
  "  uvec2 quad = texelFetch(quads, texel_place(number >> 2), 0).xy;\n"                \
  "  uint lo = quad.x, hi = quad.y;\n"                                                 \
  "  vec3 base = vec3(lo & 127u, (lo >> 7) & 127u, (lo >> 14) & 127u);\n"              \
  "  float w = float(((lo >> 21) & 127u) + 1u);\n"                                     \
  "  float h = float(((lo >> 28) | ((hi & 7u) << 4)) + 1u);\n"                         \
  "  uint d = (hi >> 3) & 7u;\n"                                                       \
  "  float cu = float(number & 1), cv = float((number >> 1) & 1);\n"                   \
  "  float side = float(d & 1u);\n"                                                    \
  "  cu = side > 0.5 ? cu : 1.0 - cu;\n"                                               \
  "  vec3 n = vec3(d < 2u, (d >> 1) == 1u, d > 3u);\n"                                 \
  "  vec3 u = n.zxy, v = n.yzx;\n"                                                     \
  "  QuadCorner c;\n"                                                                  \
  "  c.normal = n * (2.0 * side - 1.0);\n"                                             \
  "  c.outward = u * (cu * 2.0 - 1.0) + v * (cv * 2.0 - 1.0);\n"                       \
  "  c.material = (hi >> 6) & 65535u;\n"                                               \
  "  c.side = d;\n"                                                                    \
  "  c.inside = 0.5;\n"                                                                \
  "  vec3 place = vec3(side, cu * w, cv * h);\n"                                       \
  "  uint face = hi >> 22;\n"                                                          \
  "  c.top = d == 3u ? 1.0 : d == 2u ? 0.0 : d < 2u ? cu : cv;\n"                      \
  "  uint first = 0u;\n"                                                               \
  "  if (face != 0u) {\n"                                                              \
  "    c.top = 0.0;\n"                                                                 \
  "    first = texelFetch(shapes, texel_place(int(c.material)), 0).x;\n"               \
  "    vec2 low = d < 2u ? vec2(0.875, 0.0) : vec2(0.0, 0.875);\n"                     \
  "    if (first == 0u) place.yz = mix(low, vec2(w, h), vec2(cu, cv));\n"              \
  "  }\n"                                                                              \
  "  c.plane = vec2(cv, cu);\n"                                                        \
  "  c.is_shape = first != 0u;\n"                                                      \
  "  float across = -1.0;\n"                                                           \
  "  if (c.is_shape) {\n"                                                              \
  "    uint f = texelFetch(shapes, texel_place(int(first + face) - 1), 0).x;\n"        \
  "    vec3 low = vec3(f & 31u, (f >> 10) & 31u, (f >> 20) & 31u) * 0.0625;\n"         \
  "    vec3 high = vec3((f >> 5) & 31u, (f >> 15) & 31u, (f >> 25) & 31u) * 0.0625;\n" \
  "    place = vec3(mix(low.x, high.x, cv), mix(low.y, high.y + w - 1.0, cu),\n"       \
  "                 mix(low.z, high.z + h - 1.0, cv));\n"                              \
  "    c.inside = 0.03125;\n"                                                          \
  "    if (low.x != high.x) {\n"                                                       \
  "      c.normal = vec3(0.0, 1.0, 0.0);\n"                                            \
  "      c.inside = 0.0;\n"                                                            \
  "      across = cv;\n"                                                               \
  "    }\n"                                                                            \
  "  }\n"                                                                              \
  "  c.at = base + n * place.x + u * place.y + v * place.z;\n"                         \
  "  c.across = across < 0.0 ? c.at : vec3(c.at.xy, base.z + across);\n"               \
  "  return c;\n"                                                                      \
  "}\n"

}  // namespace runstone
