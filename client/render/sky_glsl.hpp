// Moon, stars and clouds in GLSL, for the shader of the sky alone: fog fades into the plain sky of
// RUNSTONE_LIGHT_GLSL, which all of them require.
#pragma once

namespace runstone {

/// vec3 with_disc(vec3 c, vec3 d): `c` with the disc of the sun, or of the moon with RUNSTONE_MOON,
/// 2 degrees in radius. The moon is nearly full, and has darker plains.
#define RUNSTONE_DISC_GLSL                                                          \
  "vec3 with_disc(vec3 c, vec3 d) {\n"                                              \
  "  float near = dot(d, sun_direction);\n"                                         \
  "  c += glow * (0.5 * pow(max(near, 0.0), 300.0));\n"                             \
  "  if (near < 0.998) return c;\n"                                                 \
  "#ifndef RUNSTONE_MOON\n"                                                         \
  "  return c + glow * (6.0 * smoothstep(0.9990, 0.9995, near));\n"                 \
  "#else\n"                                                                         \
  "  vec3 right = normalize(cross(sun_direction, vec3(0.0, 1.0, 0.0)));\n"          \
  "  vec2 at = vec2(dot(d, right), dot(d, cross(right, sun_direction))) / 0.036;\n" \
  "  float rim = dot(at, at);\n"                                                    \
  "  vec3 ball = vec3(at, sqrt(max(1.0 - rim, 0.0)));\n"                            \
  "  float lit = smoothstep(-0.15, 0.45, dot(ball, vec3(0.55, 0.20, 0.81)));\n"     \
  "  float plain = textureLod(noise, at * 0.05 + 0.37, 0.0).r;\n"                   \
  "  float bright = lit * mix(0.55, 1.0, smoothstep(0.38, 0.60, plain));\n"         \
  "  float share = 1.0 - smoothstep(0.90, 1.0, rim);\n"                             \
  "  return mix(c, vec3(0.33, 0.34, 0.35) * bright + zenith,\n"                     \
  "             share * smoothstep(0.0, 0.08, glow.b));\n"                          \
  "#endif\n"                                                                        \
  "}\n"

/// vec3 starlight(vec3 d): the stars and the milky way in a direction. Each cell of a grid on the
/// faces of a cube may have a star; few are bright. A star is as wide as a pixel.
#define RUNSTONE_STARS_GLSL                                                                      \
  "uniform float stars, pixel;\n"                                                                \
  "uniform vec2 star_turn;\n"                                                                    \
  "uint star_hash(uvec3 p) {\n"                                                                  \
  "  uint h = p.x * 73856093u ^ p.y * 19349663u ^ p.z * 83492791u;\n"                            \
  "  h = (h ^ (h >> 15)) * 2246822519u;\n"                                                       \
  "  h = (h ^ (h >> 13)) * 3266489917u;\n"                                                       \
  "  return h ^ (h >> 16);\n"                                                                    \
  "}\n"                                                                                          \
  "vec3 starlight(vec3 d) {\n"                                                                   \
  "  vec3 s = vec3(d.x * star_turn.x - d.y * star_turn.y,\n"                                     \
  "                d.x * star_turn.y + d.y * star_turn.x, d.z);\n"                               \
  "  vec3 a = abs(s);\n"                                                                         \
  "  float most = max(a.x, max(a.y, a.z));\n"                                                    \
  "  bool is_x = a.x == most, is_y = a.y == most;\n"                                             \
  "  float along = is_x ? s.x : is_y ? s.y : s.z;\n"                                             \
  "  vec2 at = (is_x ? s.yz : is_y ? s.xz : s.xy) * (40.0 / most);\n"                            \
  "  uint face = (is_x ? 0u : is_y ? 2u : 4u) + (along > 0.0 ? 1u : 0u);\n"                      \
  "  uint h = star_hash(uvec3(uvec2(floor(at) + 64.0), face));\n"                                \
  "  float band = dot(s, vec3(0.48, 0.60, 0.64));\n"                                             \
  "  float milky = exp2(-band * band * 24.0);\n"                                                 \
  "  float cloud = textureLod(noise, s.xy * 0.4 + s.z * vec2(0.23, 0.31), 0.0).r;\n"             \
  "  vec3 c = vec3(0.0100, 0.0110, 0.0140) * (milky * smoothstep(0.15, 0.85, cloud));\n"         \
  "  if (float(h & 63u) > 9.0 + 14.0 * milky) return c;\n"                                       \
  "  vec2 place = 0.15 + 0.7 * vec2(float((h >> 6) & 255u), float((h >> 14) & 255u)) / 255.0;\n" \
  "  float far = length(fract(at) - place) / 40.0;\n"                                            \
  "  float size = float((h >> 22) & 255u) / 255.0;\n"                                            \
  "  float bright = 0.03 + 0.55 * size * size * size * size;\n"                                  \
  "  vec3 hue = mix(vec3(1.0, 0.86, 0.72), vec3(0.78, 0.88, 1.0), float(h >> 30) / 3.0);\n"      \
  "  float wide = pixel * (0.75 + 0.55 * size * size);\n"                                        \
  "  return c + hue * (bright * (1.0 - smoothstep(0.4 * wide, 1.25 * wide, far)));\n"            \
  "}\n"

/// vec4 clouds(vec3 d): the colour of the clouds in a direction, and the share of them. They are
/// flat, and so high above the eye that nobody reaches them. `cloud_place` is the eye in the
/// texture of the noise, and the way to a cloud that is straight above. Clouds are darker where
/// they are thick.
#define RUNSTONE_CLOUDS_GLSL                                                            \
  "uniform vec3 cloud_place, cloud_lit, cloud_shade;\n"                                 \
  "uniform float cloud_cover;\n"                                                        \
  "vec4 clouds(vec3 d) {\n"                                                             \
  "  vec2 at = cloud_place.xy + d.xz * (cloud_place.z / max(d.y, 0.04));\n"             \
  "  float thick = texture(noise, at).r + 0.22 * texture(noise, at * 5.0).r - 0.11;\n"  \
  "  float share = smoothstep(0.50, 0.68, thick) * smoothstep(0.05, 0.24, d.y);\n"      \
  "  float s = max(dot(d, sun_direction), 0.0);\n"                                      \
  "  s *= s; s *= s; s *= s;\n"                                                         \
  "  float shade = smoothstep(0.56, 0.86, thick);\n"                                    \
  "  vec3 c = mix(cloud_lit, cloud_shade, shade) + glow * (0.5 * s * (1.0 - shade));\n" \
  "  return vec4(c, share * cloud_cover * 0.96);\n"                                     \
  "}\n"

}  // namespace runstone
