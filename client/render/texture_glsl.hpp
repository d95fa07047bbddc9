// The textures of a world in GLSL. RUNSTONE_TEXTURES reads them (TextureArray), RUNSTONE_HOLES
// leaves out the pixels of holes in the faces of shapes, and RUNSTONE_ALL_HOLES those in all faces.
// The latter is for transparent faces, whose two sides are drawn. The planes of a plant have a face
// on each side, so of shapes it draws the front alone.
//   - On the four lateral sides a picture is upright and not mirrored. Its right is that of a
//     viewer who stands before the side.
//   - On the upper side its right is +x and its upper edge is at -z; on the lower side its right is
//     +x and its upper edge is at +z.
//   - It covers a voxel. A face of a shape shows the part of the picture that lies at its place. On
//     the planes of a plant it is as wide as a plane.
#pragma once
#include "client/render/quad_glsl.hpp"

namespace runstone {

/// For vertex shaders. Requires RUNSTONE_QUAD_GLSL. `texture_layer` is 0 if the side has no
/// picture, otherwise 1 + its layer; it is negative for a face of a shape.
#define RUNSTONE_TO_TEXTURE_GLSL                                                            \
  "#ifdef RUNSTONE_TEXTURES\n"                                                              \
  "uniform usampler2D texture_layers;\n"                                                    \
  "flat out int texture_layer;\n"                                                           \
  "out vec2 texture_place;\n"                                                               \
  "void to_texture(QuadCorner c) {\n"                                                       \
  "  int side = int(c.material) * 8 + int(c.side);\n"                                       \
  "  texture_layer = int(texelFetch(texture_layers, texel_place(side), 0).x);\n"            \
  "  if (c.is_shape) texture_layer = -texture_layer;\n"                                     \
  "  vec3 p = c.across;\n"                                                                  \
  "  float right = c.side == 0u ? p.z : c.side == 1u ? -p.z : c.side == 4u ? -p.x : p.x;\n" \
  "  float down = c.side == 2u ? -p.z : c.side == 3u ? p.z : -p.y;\n"                       \
  "  texture_place = vec2(right, down);\n"                                                  \
  "}\n"                                                                                     \
  "#endif\n"

/// For fragment shaders. Requires `colour`, that of the material, and with RUNSTONE_ALL_HOLES
/// `look`. surface_colour() is the linear colour and the alpha at the fragment; is_textured() is
/// true if a picture gives them. Only the picture of a pane decides where the pane is opaque. A
/// liquid stays as clear as its material.
#define RUNSTONE_TEXTURE_GLSL                                                 \
  "#ifdef RUNSTONE_TEXTURES\n"                                                \
  "uniform sampler2DArray textures;\n"                                        \
  "flat in int texture_layer;\n"                                              \
  "in vec2 texture_place;\n"                                                  \
  "bool is_textured() { return texture_layer != 0; }\n"                       \
  "vec4 surface_colour() {\n"                                                 \
  "  if (texture_layer == 0) return colour;\n"                                \
  "  float layer = float(abs(texture_layer) - 1);\n"                          \
  "  vec4 texel = texture(textures, vec3(texture_place, layer));\n"           \
  "#ifdef RUNSTONE_HOLES\n"                                                   \
  "  if (texture_layer < 0 && texel.a < 0.5) discard;\n"                      \
  "#endif\n"                                                                  \
  "#ifdef RUNSTONE_ALL_HOLES\n"                                               \
  "  if (texel.a < 0.5 || (texture_layer < 0 && !gl_FrontFacing)) discard;\n" \
  "  if (look.a >= 15.0) texel.a *= colour.a;\n"                              \
  "#endif\n"                                                                  \
  "  return texel;\n"                                                         \
  "}\n"                                                                       \
  "#else\n"                                                                   \
  "bool is_textured() { return false; }\n"                                    \
  "vec4 surface_colour() { return colour; }\n"                                \
  "#endif\n"

}  // namespace runstone
