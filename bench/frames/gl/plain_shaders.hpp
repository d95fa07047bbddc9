// The GLSL of PlainRenderer. The colour of a pixel is a function of the visible plane: its
// direction, the place along it, and the material. A mesher cannot influence it, so equal voxels
// give equal pixels.
#pragma once

namespace runstone::bench {

#define RUNSTONE_PLAIN_COLOUR_GLSL                                                         \
  "vec3 colour_of(vec3 at, uint direction, uint material) {\n"                             \
  "  uint layer = uint(int(at[int(direction >> 1)]));\n"                                   \
  "  uint h = material * 2654435761u;\n"                                                   \
  "  vec3 base = 0.6 + 0.4 * vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) / 255.0;\n" \
  "  float light = 0.4 + 0.1 * float(direction);\n"                                        \
  "  float tint = float((layer * 37u) & 63u) / 255.0;\n"                                   \
  "  return base * light * (1.0 - tint);\n"                                                \
  "}\n"

inline constexpr const char* kPlainVertexShader =
    // x, y, z, direction (bench/frames/indexed_mesh.hpp)
    "layout(location = 0) in uvec4 place;\n"
    "layout(location = 1) in uint material;\n"
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"  // of the chunk in the block; whole numbers, so sums are exact
    "flat out vec3 colour;\n" RUNSTONE_PLAIN_COLOUR_GLSL
    "void main() {\n"
    "  vec3 at = origin + vec3(place.xyz);\n"
    "  gl_Position = clip * vec4(at, 1.0);\n"
    "  colour = colour_of(at, place.w, material);\n"
    "}\n";

// The same for packed quads, an instance each, as the client draws them
// (client/render/shaders.hpp).
inline constexpr const char* kPackedVertexShader =
    "layout(location = 0) in uvec2 quad;\n"  // common/mesh/quad.hpp, low word first
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"
    "flat out vec3 colour;\n" RUNSTONE_PLAIN_COLOUR_GLSL
    "void main() {\n"
    "  uint lo = quad.x, hi = quad.y;\n"
    "  vec3 at = origin + vec3(lo & 127u, (lo >> 7) & 127u, (lo >> 14) & 127u);\n"
    "  float width = float(((lo >> 21) & 127u) + 1u);\n"
    "  float height = float(((lo >> 28) | ((hi & 7u) << 4)) + 1u);\n"
    "  uint direction = (hi >> 3) & 7u;\n"
    "  uint material = (hi >> 6) & 65535u;\n"
    "  int axis = int(direction >> 1);\n"
    "  bool positive = (direction & 1u) != 0u;\n"
    "  float u = float(gl_VertexID & 1), v = float(gl_VertexID >> 1);\n"
    "  if (!positive) u = 1.0 - u;\n"  // winds the other way round
    "  at[axis] += positive ? 1.0 : 0.0;\n"
    "  at[(axis + 1) % 3] += u * width;\n"
    "  at[(axis + 2) % 3] += v * height;\n"
    "  gl_Position = clip * vec4(at, 1.0);\n"
    "  colour = colour_of(at, direction, material);\n"
    "}\n";

#undef RUNSTONE_PLAIN_COLOUR_GLSL

inline constexpr const char* kPlainFragmentShader =
    "flat in vec3 colour;\n"
    "out vec4 fragment;\n"
    "void main() { fragment = vec4(colour, 1.0); }\n";

// GPUs shade blocks of 2 x 2 pixels. Lanes of a block outside the triangle, and hidden ones,
// compute derivatives and are discarded. Each remaining fragment adds 4 / (remaining fragments in
// its block), so that a block adds 4, however many of its lanes are discarded.
inline constexpr const char* kLanesFragmentShader =
    "#extension GL_ARB_ES3_1_compatibility : require\n"  // gl_HelperInvocation
    "#extension GL_ARB_derivative_control : require\n"   // dFdxFine()
    "flat in vec3 colour;\n"
    "out float lanes;\n"
    "void main() {\n"
    "  ivec2 odd = ivec2(gl_FragCoord.xy) & 1;\n"
    "  float own = gl_HelperInvocation ? 0.0 : 1.0;\n"
    "  float row = own + own + (odd.x == 0 ? dFdxFine(own) : -dFdxFine(own));\n"
    "  float block = row + row + (odd.y == 0 ? dFdyFine(row) : -dFdyFine(row));\n"
    "  lanes = 4.0 / block;\n"
    "}\n";

}  // namespace runstone::bench
