// The light of a moment in GLSL, which sky, terrain, bodies and water share: fog fades into exactly
// the colour of the sky behind it.
#pragma once
#include "client/render/day_light.hpp"
#include "client/render/gl_handle.hpp"

namespace runstone {

// field_lit() is the light of lamps and sky at a place of the light field (RUNSTONE_FIELD_GLSL),
// and in_field() that of a side whose sky_light() is known. display() is the only step from linear
// light to the picture: the filmic curve of Hejl and Burgess-Dawson (2010), a quotient of
// polynomials that includes the encoding to sRGB. Its cut of the darkest tones is left out, because
// caves would be black. At night, dim places lose most of their colour and become bluish, as eyes
// see them. Places in the light of lamps keep their colour. In ambient light the walls along x are
// a little darker and those towards the sun a little brighter, so that hills in the shade and far
// away keep their shape. fog_share() is the share of the haze between the eye and a place, from 0
// to 1. The air is half as thick each 300 voxels higher, so valleys are hazier than peaks.
#define RUNSTONE_LIGHT_GLSL                                                          \
  "uniform vec3 sun_direction, sun_colour, zenith, horizon, nadir, glow;\n"          \
  "uniform vec3 ambient_up, ambient_side, ambient_down, dark;\n"                     \
  "uniform float exposure, lamps, night, eye_height;\n"                              \
  "uniform vec4 fog;\n"                                                              \
  "vec3 sky(vec3 d) {\n"                                                             \
  "  float low = 1.0 - clamp(d.y, 0.0, 1.0);\n"                                      \
  "  vec3 c = mix(zenith, horizon, low * low * low);\n"                              \
  "  c = mix(c, nadir, clamp(-d.y * 3.0, 0.0, 1.0));\n"                              \
  "  float s = max(dot(d, sun_direction), 0.0);\n"                                   \
  "  float s4 = s * s * s * s, s16 = s4 * s4 * s4 * s4;\n"                           \
  "  return c + glow * (0.08 * s4 + 0.25 * s16 * s16);\n"                            \
  "}\n"                                                                              \
  "vec3 sky_light(vec3 n) {\n"                                                       \
  "  vec3 c = mix(ambient_side, n.y > 0.0 ? ambient_up : ambient_down, abs(n.y));\n" \
  "  return c * (1.0 - 0.10 * abs(n.x) + 0.10 * dot(n.xz, sun_direction.xz));\n"     \
  "}\n"                                                                              \
  "vec3 in_field(vec4 around, vec3 from_sky) {\n"                                    \
  "  float open = mix(0.08, 1.0, around.a * (0.4 + 0.6 * around.a));\n"              \
  "  return from_sky * open + dark + around.rgb * lamps;\n"                          \
  "}\n"                                                                              \
  "vec3 field_lit(vec4 around, vec3 n) { return in_field(around, sky_light(n)); }\n" \
  "float fog_share(vec3 relative, float far) {\n"                                    \
  "  float height = max(eye_height + 0.5 * relative.y, 0.0);\n"                      \
  "  float path = max(far - fog.x, 0.0) * fog.w;\n"                                  \
  "  float clear = exp2(-path * exp2(-height * (1.0 / 300.0)));\n"                   \
  "  return 1.0 - clear * (1.0 - smoothstep(fog.y, fog.z, far));\n"                  \
  "}\n"                                                                              \
  "vec3 in_fog(vec3 c, vec3 relative) {\n"                                           \
  "  float far = length(relative);\n"                                                \
  "  return mix(c, sky(relative / far), fog_share(relative, far));\n"                \
  "}\n"                                                                              \
  "vec3 display(vec3 c) {\n"                                                         \
  "  if (night > 0.0) {\n"                                                           \
  "    float grey = dot(c, vec3(0.25, 0.60, 0.15));\n"                               \
  "    float lost = night * clamp(1.15 - 7.0 * grey, 0.0, 1.0);\n"                   \
  "    c = mix(c, grey * vec3(0.74, 0.94, 1.42), lost);\n"                           \
  "  }\n"                                                                            \
  "  vec3 x = max(c * exposure, 0.0);\n"                                             \
  "  return (x * (6.2 * x + 0.5)) / (x * (6.2 * x + 1.7) + 0.06);\n"                 \
  "}\n"

/// Sets the uniforms of RUNSTONE_LIGHT_GLSL. Requires that the program is in use.
void set_light(const GlProgram& program, const DayLight& light);

}  // namespace runstone
