// The packed quads of common/mesh/quad.hpp in GLSL: a vertex shader reads quad and corner by the
// number of the vertex, four vertices a quad. So a draw needs no vertex attributes, and the quads
// of all chunks lie in one buffer texture.
#pragma once

namespace runstone {

/// The corners of a quad stand in the order 0: (0, 0), 1: (1, 0), 2: (0, 1), 3: (1, 1) along u and
/// v; a negative face reverses u, so that it has the opposite winding.
#define RUNSTONE_QUAD_GLSL                                                     \
  "uniform usamplerBuffer quads;\n"                                            \
  "struct QuadCorner { vec3 at, normal, outward; uint material; };\n"          \
  "QuadCorner quad_corner() {\n"                                               \
  "  uvec2 quad = texelFetch(quads, gl_VertexID >> 2).xy;\n"                   \
  "  uint lo = quad.x, hi = quad.y;\n"                                         \
  "  vec3 base = vec3(lo & 127u, (lo >> 7) & 127u, (lo >> 14) & 127u);\n"      \
  "  float w = float(((lo >> 21) & 127u) + 1u);\n"                             \
  "  float h = float(((lo >> 28) | ((hi & 7u) << 4)) + 1u);\n"                 \
  "  uint d = (hi >> 3) & 7u;\n"                                               \
  "  float cu = float(gl_VertexID & 1), cv = float((gl_VertexID >> 1) & 1);\n" \
  "  float side = float(d & 1u);\n"                                            \
  "  cu = side > 0.5 ? cu : 1.0 - cu;\n"                                       \
  "  vec3 n = vec3(d < 2u, (d >> 1) == 1u, d > 3u);\n"                         \
  "  vec3 u = n.zxy, v = n.yzx;\n"                                             \
  "  QuadCorner c;\n"                                                          \
  "  c.at = base + n * side + u * (cu * w) + v * (cv * h);\n"                  \
  "  c.normal = n * (2.0 * side - 1.0);\n"                                     \
  "  c.outward = u * (cu * 2.0 - 1.0) + v * (cv * 2.0 - 1.0);\n"               \
  "  c.material = (hi >> 6) & 65535u;\n"                                       \
  "  return c;\n"                                                              \
  "}\n"

}  // namespace runstone
