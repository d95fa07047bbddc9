// The shaders of terrain, in GLSL 3.30. Their variants are chosen by definitions before the text:
// RUNSTONE_FIELD reads the light field, RUNSTONE_SHADOWS reads the shadow maps, RUNSTONE_DEPTH
// reads the depth behind water, RUNSTONE_FINE draws what is smaller than a voxel, RUNSTONE_FOG
// fades, RUNSTONE_TILE is for parts of tiles, RUNSTONE_LIQUID lowers the surfaces of liquids,
// RUNSTONE_FADE draws a part of the pixels, and RUNSTONE_GLOSSY mirrors sun and sky. The switches
// of textures stand in texture_glsl.hpp, and the switch of plants in plant_glsl.hpp. A software
// driver computes both sides of a branch, so code that only few chunks need is a variant.
#pragma once
#include "client/render/light_glsl.hpp"
#include "client/render/light_texture.hpp"
#include "client/render/liquid_surface.hpp"
#include "client/render/place_tint_glsl.hpp"
#include "client/render/plant_glsl.hpp"
#include "client/render/quad_glsl.hpp"
#include "client/render/shadow_maps.hpp"
#include "client/render/surface_glsl.hpp"
#include "client/render/texture_glsl.hpp"

namespace runstone {

/// The screen door of fades: the pixels of a body get thresholds in a pattern of 4 x 4 (Bayer), and
/// those from drawn.x to drawn.y are drawn (FarFades).
#define RUNSTONE_FADE_GLSL                                                   \
  "#ifdef RUNSTONE_FADE\n"                                                   \
  "uniform vec2 drawn;\n"                                                    \
  "void fade() {\n"                                                          \
  "  ivec2 p = ivec2(gl_FragCoord.xy) & 3;\n"                                \
  "  int q = p.x ^ p.y;\n"                                                   \
  "  int rank = (q & 1) << 3 | (p.y & 1) << 2 | (q & 2) | (p.y & 2) >> 1;\n" \
  "  float threshold = (float(rank) + 0.5) / 16.0;\n"                        \
  "  if (threshold < drawn.x || threshold > drawn.y) discard;\n"             \
  "}\n"                                                                      \
  "#else\n"                                                                  \
  "void fade() {}\n"                                                         \
  "#endif\n"

inline constexpr const char* kTerrainVertexShader = RUNSTONE_QUAD_GLSL RUNSTONE_TO_SHADOW_GLSL
    RUNSTONE_TO_TEXTURE_GLSL RUNSTONE_TO_PLANT_GLSL RUNSTONE_LOWERED_GLSL RUNSTONE_LIGHT_GLSL
    "uniform mat4 clip;\n"     // clip space from eye-relative space
    "uniform vec3 origin;\n"   // chunk origin minus eye
    "uniform vec3 pattern;\n"  // chunk origin modulo 8192: coordinates fixed to the world
    "uniform float scale;\n"   // the side of a voxel
    "uniform sampler2D palette, looks;\n"
    "uniform float seam;\n"  // growth of a quad as a share of the distance
    "#ifdef RUNSTONE_TILE\n"
    "uniform float edge;\n"  // of the part of a tile, in its voxels
    "#endif\n"
    "out vec3 relative;\n"
    "out vec3 voxel;\n"
    "flat out vec3 normal;\n"
    "flat out vec4 colour;\n"
    "flat out vec4 look;\n"
    "flat out vec4 side_light;\n"  // of the sky on this side, and the share of the sun
    "#ifdef RUNSTONE_SHADOWS\n"
    "out vec3 in_shadow;\n"
    "#endif\n"
    "void main() {\n"
    "  QuadCorner c = quad_corner();\n"
    "  relative = origin + c.at * scale;\n"
    // Merged quads meet in T-junctions, where rounding leaves pinholes. So each quad grows by a
    // small fraction of a pixel across each of its edges, whatever the angle at which it is seen.
    // An axis of length 1 is seen with the length seen / distance^2, and the part of it that lies
    // across the other axis with facing / seen of the other / distance. Corners that are seen very
    // sharp would become long, so the growth along an axis is at most half a pixel.
    "  float d2 = dot(relative, relative);\n"
    "  float far = sqrt(d2);\n"
    "  vec3 seen = sqrt(max(d2 - relative * relative, 0.0004 * d2));\n"
    "  vec3 growth = seam * d2 / seen;\n"
    "  float facing = max(abs(dot(c.normal, relative)), 0.0001 * far);\n"
    "  vec3 other = dot(seen, 1.0 - abs(c.normal)) - seen;\n"
    "  if (c.inside > 0.0) growth = clamp(seam * far * other / facing, growth, 15.0 * growth);\n"
    "  vec3 outward = c.outward;\n"
    "#ifdef RUNSTONE_TILE\n"
    // The faces on the border of a part are drawn also where the ground of the next part covers
    // them. There the growth would show them as dots: above flat ground, and on cliffs. So walls
    // grow neither upward nor at the ends of the part, and all of these faces lie a little farther
    // than they are, walls more than the others. Pixels stay, depths change by less than a voxel.
    "  vec3 end = vec3(equal(abs(c.at - 0.5 * edge), vec3(0.5 * edge)));\n"
    "  float on_border = dot(end, abs(c.normal));\n"
    "  float is_wall = on_border * (1.0 - abs(c.normal.y));\n"
    "  outward *= 1.0 - is_wall * end;\n"
    "  outward.y = min(outward.y, 1.0 - is_wall);\n"
    "  float behind = seam * (10.0 + 1.5 * far / max(abs(relative.y), 0.25));\n"
    "  float bias = (on_border + is_wall) * min(behind, 0.45 * scale / far);\n"
    "#endif\n"
    "  relative += outward * growth;\n"
    "#ifdef RUNSTONE_TILE\n"
    "  relative *= 1.0 + bias;\n"
    "#endif\n"
    "  voxel = pattern + c.at - c.normal * c.inside;\n"
    "  normal = c.normal;\n"
    "  side_light = vec4(sky_light(normal), max(dot(normal, sun_direction), 0.0));\n"
    "  ivec2 row = ivec2(c.material & 255u, c.material >> 8);\n"
    "  colour = texelFetch(palette, row, 0);\n"
    "  look = plant_look(c, texelFetch(looks, row, 0));\n"
    "#ifdef RUNSTONE_LIQUID\n"
    "  relative.y -= lowered(c, colour, look);\n"
    "#endif\n"
    "#ifdef RUNSTONE_SHADOWS\n"
    "  in_shadow = to_shadow(relative, normal);\n"
    "#endif\n"
    "#ifdef RUNSTONE_TEXTURES\n"
    "  to_texture(c);\n"
    "#endif\n"
    "  gl_Position = clip * vec4(relative, 1.0);\n"
    "}\n";

inline constexpr const char* kTerrainFragmentShader =
    "in vec3 relative;\n"
    "in vec3 voxel;\n"
    "flat in vec3 normal;\n"
    "flat in vec4 colour;\n"
    "flat in vec4 look;\n"  // variation, grain, emission, surface
    "flat in vec4 side_light;\n"
    "#ifdef RUNSTONE_SHADOWS\n"
    "in vec3 in_shadow;\n"
    "#endif\n"
    "out vec4 fragment;\n" RUNSTONE_LIGHT_GLSL RUNSTONE_FIELD_GLSL RUNSTONE_SHADOW_GLSL
        RUNSTONE_FADE_GLSL RUNSTONE_TEXTURE_GLSL RUNSTONE_HASH_GLSL RUNSTONE_SURFACE_PARTS_GLSL
            RUNSTONE_GLOSS_GLSL RUNSTONE_PLACE_TINT_GLSL RUNSTONE_PLANT_GLSL
    "#ifdef RUNSTONE_FINE\n" RUNSTONE_PATTERN_GLSL
    "#endif\n"
    "void main() {\n"
    "  fade();\n"
    "  vec4 colour = is_textured() ? surface_colour() : in_silhouette(colour);\n"
    // Each voxel has a slightly different tint, so that merged faces still look like voxels. The
    // detail fades out with distance before it would flicker.
    "  vec3 face = abs(normal);\n"
    "  vec2 st = face.x > 0.5 ? voxel.zy : face.y > 0.5 ? voxel.xz : voxel.xy;\n"
    "  float pixel = max(fwidth(st.x), fwidth(st.y));\n"
    "  float detail = clamp(1.5 - 3.0 * pixel, 0.0, 1.0);\n"
    "  vec2 edge = abs(fract(st) - 0.5);\n"
    "  float rim = smoothstep(0.5 - 0.06, 0.5, max(edge.x, edge.y));\n"
    "  float tint = 1.0 + detail * (look.r * hash(ivec3(floor(voxel))) - 0.07 * rim);\n"
    "#ifdef RUNSTONE_FINE\n"
    "  float fine = clamp(1.5 - 24.0 * pixel, 0.0, 1.0);\n"
    // Across the face, the place lies on the border of two cells. Without the shift, rounding would
    // choose the cell.
    "  tint += fine * look.g * hash(ivec3(floor(voxel * 8.0 + 0.25)));\n"
    "  tint *= mix(1.0, shade(st, face.y), fine);\n"
    "#endif\n"
    "  if (is_textured()) tint = 1.0;\n"
    "  float sun = side_light.a;\n"
    "#ifdef RUNSTONE_SHADOWS\n"
    "  sun *= sunlit(in_shadow);\n"
    "#endif\n"
    "  float open = 1.0;\n"
    "#ifdef RUNSTONE_FIELD\n"
    // The light in front of the face. Far away the place lies farther from the face, where the dark
    // corners are wider than they are deep; otherwise they would flicker.
    "  vec4 around = field_light(relative + normal * (0.5 + min(pixel, 1.0)));\n"
    "  open = around.a;\n"
    "  vec3 light = sun_colour * (sun * (0.5 + 0.5 * open)) + in_field(around, side_light.rgb);\n"
    "#else\n"
    "  vec3 light = sun_colour * sun + side_light.rgb + dark;\n"
    "#endif\n"
    "  vec3 lit = colour.rgb * by_place() * tint * (light + look.b * lamps * 1.1);\n"
    "#ifdef RUNSTONE_GLOSSY\n"
    "  lit = gloss(lit, colour.rgb, normal, relative, sun, open);\n"
    "#endif\n"
    "#ifdef RUNSTONE_FOG\n"
    "  lit = in_fog(lit, relative);\n"
    "#endif\n"
    "  fragment = vec4(display(lit), 1.0);\n"
    "}\n";

// Water and glass. The surface of a liquid moves and reflects the sky at flat angles; the path of
// the sight through the liquid absorbs light.
inline constexpr const char* kTransparentFragmentShader =
    "in vec3 relative;\n"
    "in vec3 voxel;\n"
    "flat in vec3 normal;\n"
    "flat in vec4 colour;\n"
    "flat in vec4 look;\n"
    "uniform float seconds;\n"
    "uniform sampler2D scene_depth;\n"
    "uniform vec3 distance_terms;\n"
    "#ifdef RUNSTONE_SHADOWS\n"
    "in vec3 in_shadow;\n"
    "#endif\n"
    "out vec4 fragment;\n" RUNSTONE_LIGHT_GLSL RUNSTONE_FIELD_GLSL RUNSTONE_SHADOW_GLSL
        RUNSTONE_SURFACE_PARTS_GLSL RUNSTONE_FADE_GLSL RUNSTONE_TEXTURE_GLSL
    "float distance_of(float depth) {\n"
    "  return distance_terms.x / (distance_terms.y * depth + distance_terms.z);\n"
    "}\n"
    "void main() {\n"
    "  fade();\n"
    "  vec4 colour = surface_colour();\n"
    "#ifdef RUNSTONE_DEPTH\n"
    "  float scene = texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).x;\n"
    "  if (distance_of(gl_FragCoord.z) >= distance_of(scene)) discard;\n"
    "#endif\n"
    "  float far = length(relative);\n"
    "  vec3 sight = relative / far;\n"
    "  vec3 n = dot(normal, sight) > 0.0 ? -normal : normal;\n"
    "  float liquid = is_liquid() ? 1.0 : 0.0;\n"
    // The surface of a liquid from below: it shows what is above where the sight is steep, and
    // mirrors the liquid elsewhere.
    "  float below = n.y < -0.5 && normal.y > 0.5 ? liquid : 0.0;\n"
    "#ifdef RUNSTONE_TILE\n"
    // The waterline where levels meet looks like the surface.
    "  if (liquid > 0.5 && abs(n.y) < 0.5) n = vec3(0.0, 1.0, 0.0);\n"
    "#endif\n"
    "  vec3 wave = n;\n"
    "  vec2 p = voxel.xz;\n"
    "  float calm = 1.0 / (1.0 + 0.02 * far);\n"
    "  wave.x += liquid * calm * (0.05 * sin(p.x * 1.7 + p.y * 0.6 + seconds * 1.3) +\n"
    "                             0.03 * sin(p.x * 3.1 - p.y * 2.3 - seconds * 1.9));\n"
    "  wave.z += liquid * calm * (0.05 * cos(p.y * 1.9 - p.x * 0.5 + seconds * 1.1) +\n"
    "                             0.03 * cos(p.x * 2.7 + p.y * 2.9 + seconds * 2.1));\n"
    "  wave = normalize(wave);\n"
    "  float facing = clamp(-dot(sight, wave), 0.0, 1.0);\n"
    "  float f = 1.0 - facing;\n"
    "  float fresnel = 0.03 + 0.75 * f * f * f * f;\n"
    "  fresnel = mix(fresnel, 1.0 - smoothstep(0.45, 0.75, facing), below);\n"
    "  float sun = max(dot(n, sun_direction), 0.0);\n"
    "#ifdef RUNSTONE_SHADOWS\n"
    "  float lit_by_sun = sunlit(in_shadow);\n"
    "#else\n"
    "  float lit_by_sun = 1.0;\n"
    "#endif\n"
    "#ifdef RUNSTONE_FIELD\n"
    "  vec4 around = field_light(relative + n * 0.5);\n"
    "#else\n"
    "  vec4 around = vec4(0.0, 0.0, 0.0, 1.0);\n"
    "#endif\n"
    "  vec3 body = colour.rgb * (sun_colour * (sun * lit_by_sun) + field_lit(around, n));\n"
    "  vec3 mirrored = reflect(sight, wave);\n"
    "  mirrored.y = abs(mirrored.y);\n"
    "  vec3 reflection = sky(mirrored) * (0.25 + 0.75 * around.a);\n"
    "  float s = max(dot(mirrored, sun_direction), 0.0);\n"
    "  float s8 = s * s; s8 *= s8; s8 *= s8; float s64 = s8 * s8; s64 *= s64; s64 *= s64;\n"
    "  reflection += sun_colour * (s64 * s64 * 2.0 * lit_by_sun);\n"
    "  body = mix(body, ambient_up * 1.4 + sun_colour * (0.25 * lit_by_sun), below);\n"
    "  float deep = colour.a;\n"
    "#ifdef RUNSTONE_DEPTH\n"
    // Both distances are along the view axis.
    "  float here = distance_of(gl_FragCoord.z);\n"
    "  float path = (1.0 - below) * max(distance_of(scene) - here, 0.0) * far / here;\n"
    "  float absorbed = 1.0 - exp(-0.16 * path);\n"
    "  deep = mix(deep, mix(0.35, 0.96, absorbed), liquid);\n"
    "  deep = mix(deep, 0.6, below);\n"
    "  body = mix(body, body * mix(1.25, 0.55, absorbed), liquid - below);\n"
    "#endif\n"
    "  vec3 c = mix(body, reflection, fresnel * mix(0.53 * (1.0 - roughness()), 1.0, liquid));\n"
    "  float fogged = fog_share(relative, far);\n"
    "  fragment = vec4(display(mix(c + colour.rgb * look.b * lamps * 1.1, sky(sight), fogged)),\n"
    "                  max(mix(deep, 1.0, fresnel), fogged));\n"
    "}\n";

}  // namespace runstone
