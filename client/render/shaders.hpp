// The shaders, in GLSL 3.30 for OpenGL 3.3 core and newer.
#pragma once

namespace runstone {

// The colour of the sky in a direction. Sky and terrain share it, so that fog fades into exactly
// this colour.
#define RUNSTONE_SKY_GLSL                                                                         \
  "const vec3 kSun = normalize(vec3(0.55, 0.70, 0.35));\n"                                        \
  "vec3 sky(vec3 d) {\n"                                                                          \
  "  float up = clamp(d.y, 0.0, 1.0);\n"                                                          \
  "  vec3 c = mix(vec3(0.80, 0.87, 0.93), vec3(0.26, 0.48, 0.80), pow(up, 0.55));\n"              \
  "  c = mix(c, vec3(0.58, 0.66, 0.72), clamp(-d.y * 4.0, 0.0, 1.0));\n"                          \
  "  float s = max(dot(d, kSun), 0.0);\n"                                                         \
  "  return c + vec3(1.0, 0.85, 0.60) * (0.25 * pow(s, 24.0) + 2.0 * smoothstep(0.9993, 0.9997, " \
  "s));\n"                                                                                        \
  "}\n"

inline constexpr const char* kQuadVertexShader =
    "#version 330 core\n"
    "layout(location = 0) in uvec2 quad;\n"  // common/mesh/quad.hpp, low word first
    "uniform mat4 clip;\n"                   // clip space from eye-relative space
    "uniform vec3 origin;\n"                 // chunk origin minus eye
    "uniform vec3 pattern;\n"  // chunk origin modulo 4096: world-fixed texture coordinates
    "uniform sampler2D palette;\n"
    "uniform float seam;\n"  // growth of a quad per unit of distance
    "out vec3 relative;\n"
    "out vec3 voxel;\n"
    "flat out vec3 normal;\n"
    "flat out vec4 colour;\n"
    "void main() {\n"
    "  uint lo = quad.x, hi = quad.y;\n"
    "  vec3 base = vec3(lo & 127u, (lo >> 7) & 127u, (lo >> 14) & 127u);\n"
    "  float w = float(((lo >> 21) & 127u) + 1u);\n"
    "  float h = float(((lo >> 28) | ((hi & 7u) << 4)) + 1u);\n"
    "  uint d = (hi >> 3) & 7u;\n"
    "  uint id = (hi >> 6) & 65535u;\n"
    "  int axis = int(d >> 1);\n"
    "  bool positive = (d & 1u) != 0u;\n"
    "  int corner = gl_VertexID & 3;\n"
    "  float cu = float(corner & 1), cv = float(corner >> 1);\n"
    // A negative face reverses u, so that its strip has the opposite winding.
    "  if (!positive) cu = 1.0 - cu;\n"
    "  vec3 n = vec3(0.0), u = vec3(0.0), v = vec3(0.0);\n"
    "  n[axis] = 1.0; u[(axis + 1) % 3] = 1.0; v[(axis + 2) % 3] = 1.0;\n"
    "  vec3 local = base + (positive ? n : vec3(0.0)) + u * (cu * w) + v * (cv * h);\n"
    "  relative = origin + local;\n"
    // Merged quads meet in T-junctions. Each quad grows by a fraction of a pixel, which closes
    // pinholes there.
    "  relative += (u * (cu * 2.0 - 1.0) + v * (cv * 2.0 - 1.0)) * length(relative) * seam;\n"
    "  voxel = pattern + local - (positive ? n : -n) * 0.5;\n"
    "  normal = positive ? n : -n;\n"
    "  colour = texelFetch(palette, ivec2(id & 255u, id >> 8), 0);\n"
    "  gl_Position = clip * vec4(relative, 1.0);\n"
    "}\n";

inline constexpr const char* kQuadFragmentShader =
    "#version 330 core\n"
    "in vec3 relative;\n"
    "in vec3 voxel;\n"
    "flat in vec3 normal;\n"
    "flat in vec4 colour;\n"
    "uniform float fog_start;\n"
    "uniform float fog_end;\n"
    "out vec4 fragment;\n" RUNSTONE_SKY_GLSL
    "float hash(ivec3 p) {\n"
    "  uint h = uint(p.x) * 73856093u ^ uint(p.y) * 19349663u ^ uint(p.z) * 83492791u;\n"
    "  h = (h ^ (h >> 13)) * 1274126177u;\n"
    "  return float((h >> 16) & 255u) / 255.0;\n"
    "}\n"
    "void main() {\n"
    "  float far = length(relative);\n"
    "  vec3 dir = relative / far;\n"
    "  float sun = max(dot(normal, kSun), 0.0);\n"
    "  float skylight = 0.5 + 0.5 * normal.y;\n"
    "  vec3 light = vec3(1.00, 0.93, 0.80) * (0.75 * sun) + mix(vec3(0.33, 0.31, 0.30), "
    "vec3(0.44, 0.52, 0.62), skylight);\n"
    // Each voxel has a slightly different tint, so that merged faces still look like voxels. The
    // tint fades out with distance before it would flicker.
    "  vec3 face = abs(normal);\n"
    "  vec2 st = face.x > 0.5 ? voxel.yz : face.y > 0.5 ? voxel.zx : voxel.xy;\n"
    "  float pixel = max(fwidth(st.x), fwidth(st.y));\n"
    "  float detail = clamp(1.5 - 3.0 * pixel, 0.0, 1.0);\n"
    "  vec2 edge = abs(fract(st) - 0.5);\n"
    "  float rim = smoothstep(0.5 - 0.06, 0.5, max(edge.x, edge.y));\n"
    "  float tint = 1.0 + detail * (0.10 * (hash(ivec3(floor(voxel))) - 0.5) - 0.10 * rim);\n"
    "  vec3 lit = colour.rgb * light * tint;\n"
    "  float fog = smoothstep(fog_start, fog_end, far);\n"
    "  fragment = vec4(pow(mix(lit, pow(sky(dir), vec3(2.2)), fog), vec3(1.0 / 2.2)), "
    "mix(colour.a, 1.0, fog));\n"
    "}\n";

// One triangle covers the screen. The inverse of view and projection gives the direction of each
// pixel.
inline constexpr const char* kSkyVertexShader =
    "#version 330 core\n"
    "uniform mat4 relative_from_clip;\n"
    "out vec3 direction;\n"
    "void main() {\n"
    "  vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n"
    "  vec4 far = relative_from_clip * vec4(p, 1.0, 1.0);\n"
    "  direction = far.xyz / far.w;\n"
    "  gl_Position = vec4(p, 1.0, 1.0);\n"
    "}\n";

inline constexpr const char* kSkyFragmentShader =
    "#version 330 core\n"
    "in vec3 direction;\n"
    "out vec4 fragment;\n" RUNSTONE_SKY_GLSL
    "void main() { fragment = vec4(sky(normalize(direction)), 1.0); }\n";

inline constexpr const char* kMarkerVertexShader =
    "#version 330 core\n"
    "layout(location = 0) in vec3 corner;\n"
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"
    "uniform vec3 size;\n"
    "void main() { gl_Position = clip * vec4(origin + corner * size, 1.0); }\n";

inline constexpr const char* kMarkerFragmentShader =
    "#version 330 core\n"
    "uniform vec4 colour;\n"
    "out vec4 fragment;\n"
    "void main() { fragment = colour; }\n";

#undef RUNSTONE_SKY_GLSL

}  // namespace runstone
