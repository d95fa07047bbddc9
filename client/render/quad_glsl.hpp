// The packed quads of common/mesh/quad.hpp in GLSL: a vertex shader reads quad and corner by the
// number of the vertex, four vertices a quad. So a draw needs no vertex attributes, and the quads
// of all chunks lie in one texture. OpenGL adds the first vertex of a draw to that number; OpenGL
// ES 3.0 cannot, so there it is a uniform.
#pragma once
#include "client/render/texel_store.hpp"

namespace runstone {

/// The corners of a quad stand in the order 0: (0, 0), 1: (1, 0), 2: (0, 1), 3: (1, 1) along u and
/// v; a negative face reverses u, so that it has the opposite winding.
#define RUNSTONE_QUAD_GLSL                                                \
  RUNSTONE_TEXEL_GLSL                                                     \
  "uniform usampler2D quads;\n"                                           \
  "#ifdef GL_ES\n"                                                        \
  "uniform int first_vertex;\n"                                           \
  "#else\n"                                                               \
  "const int first_vertex = 0;\n"                                         \
  "#endif\n"                                                              \
  "struct QuadCorner { vec3 at, normal, outward; uint material; };\n"     \
  "QuadCorner quad_corner() {\n"                                          \
  "  int number = first_vertex + gl_VertexID;\n"                          \
  "  uvec2 quad = texelFetch(quads, texel_place(number >> 2), 0).xy;\n"   \
  "  uint lo = quad.x, hi = quad.y;\n"                                    \
  "  vec3 base = vec3(lo & 127u, (lo >> 7) & 127u, (lo >> 14) & 127u);\n" \
  "  float w = float(((lo >> 21) & 127u) + 1u);\n"                        \
  "  float h = float(((lo >> 28) | ((hi & 7u) << 4)) + 1u);\n"            \
  "  uint d = (hi >> 3) & 7u;\n"                                          \
  "  float cu = float(number & 1), cv = float((number >> 1) & 1);\n"      \
  "  float side = float(d & 1u);\n"                                       \
  "  cu = side > 0.5 ? cu : 1.0 - cu;\n"                                  \
  "  vec3 n = vec3(d < 2u, (d >> 1) == 1u, d > 3u);\n"                    \
  "  vec3 u = n.zxy, v = n.yzx;\n"                                        \
  "  QuadCorner c;\n"                                                     \
  "  c.at = base + n * side + u * (cu * w) + v * (cv * h);\n"             \
  "  c.normal = n * (2.0 * side - 1.0);\n"                                \
  "  c.outward = u * (cu * 2.0 - 1.0) + v * (cv * 2.0 - 1.0);\n"          \
  "  c.material = (hi >> 6) & 65535u;\n"                                  \
  "  return c;\n"                                                         \
  "}\n"

}  // namespace runstone
