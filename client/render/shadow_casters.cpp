#include "client/render/shadow_casters.hpp"

#include <array>
#include <glm/gtc/type_ptr.hpp>
#include <span>
#include <string>

#include "client/render/frustum.hpp"
#include "client/render/terrain_glsl.hpp"
#include "client/render/terrain_programs.hpp"
#include "client/render/terrain_units.hpp"

namespace runstone {
namespace {

// The depth of what casts shadows. RUNSTONE_HOLES is for shapes, whose faces may have holes.
constexpr const char* kDepthVertexShader =
    RUNSTONE_QUAD_GLSL RUNSTONE_TO_TEXTURE_GLSL RUNSTONE_TO_PLANT_GLSL
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"
    "uniform float seam;\n"  // growth of a quad, which closes pinholes, in voxels
    "#ifdef RUNSTONE_HOLES\n"
    "uniform vec3 pattern;\n"
    "uniform sampler2D looks;\n"
    "out vec3 voxel;\n"
    "flat out vec4 look;\n"
    "#endif\n"
    "void main() {\n"
    "  QuadCorner c = quad_corner();\n"
    "#ifdef RUNSTONE_HOLES\n"
    "  voxel = pattern + c.at;\n"
    "  look = plant_look(c, texelFetch(looks, ivec2(c.material & 255u, c.material >> 8), 0));\n"
    "#endif\n"
    "#ifdef RUNSTONE_TEXTURES\n"
    "  to_texture(c);\n"
    "#endif\n"
    "  gl_Position = clip * vec4(origin + c.at + c.outward * seam, 1.0);\n"
    "}\n";
constexpr const char* kDepthFragmentShader =
    "#ifdef RUNSTONE_HOLES\n"
    "in vec3 voxel;\n"
    "flat in vec4 look;\n"
    "const vec4 colour = vec4(1.0);\n" RUNSTONE_HASH_GLSL RUNSTONE_TEXTURE_GLSL RUNSTONE_PLANT_GLSL
    "void main() {\n"
    "  if (is_textured()) {\n"
    "    surface_colour();\n"
    "  } else {\n"
    "    in_silhouette(colour);\n"
    "  }\n"
    "}\n"
    "#else\n"
    "void main() {}\n"
    "#endif\n";

/// Uses a program and sets the uniforms of a pass. Returns what QuadBuffer::draw() takes.
GLint begin_depth(const GlProgram& program, const ShadowPass& pass, const QuadBuffer& quads) {
  glUseProgram(program.get());
  glUniformMatrix4fv(glGetUniformLocation(program.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(pass.clip));
  // Light must not leak through the T-junctions of merged quads.
  constexpr float kDepthSeam = 0.05F;  // of a pixel
  glUniform1f(glGetUniformLocation(program.get(), "seam"), kDepthSeam * pass.pixel);
  return quads.bind(program, kQuadUnit);
}

}  // namespace

const GlProgram& ShadowCasters::program_of(unsigned variant) {
  GlProgram& out = programs_[variant];
  if (!out) {
    const std::string holes =
        texture_definitions((variant & kDepthTextured) != 0, (variant & kDepthHoles) != 0, false);
    out = link_program("depth", (holes + kDepthVertexShader).c_str(),
                       (holes + kDepthFragmentShader).c_str());
  }
  return out;
}

bool ShadowCasters::draw(ShadowPass& pass, std::size_t quads_max, TerrainBodies& bodies,
                         Surfaces surfaces) {
  const GlProgram& program = program_of(0);
  const GLint first_vertex = begin_depth(program, pass, bodies.quads());
  const GLint origin = glGetUniformLocation(program.get(), "origin");
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(1.5F, 2.0F);
  const Frustum frustum(pass.clip);
  const glm::vec3 to_sun =
      glm::normalize(glm::vec3(-pass.clip[0][2], -pass.clip[1][2], -pass.clip[2][2]));
  std::array<double, 3> sun{};
  for (int i = 0; i < 3; ++i)
    sun[static_cast<std::size_t>(i)] = 1e9 * static_cast<double>(to_sun[i]);
  std::size_t quads = 0;
  shapes_.clear();
  const auto& chunks = bodies.chunks();
  auto next = pass.drawn_to ? chunks.upper_bound(*pass.drawn_to) : chunks.begin();
  for (; next != chunks.end() && quads < quads_max; ++next) {
    const auto& [key, chunk] = *next;
    pass.drawn_to = key;
    const glm::vec3 at(origin_in_world(key, chunk.edge) - pass.middle);
    if (!frustum.may_see(at, at + static_cast<float>(chunk.edge))) continue;
    if (chunk.shapes.count != 0) shapes_.push_back({chunk.shapes, at, pattern_of(key, chunk.edge)});
    spans_.clear();
    chunk.opaque.append_facing(sun, spans_);
    quads += chunk.shapes.count;
    if (spans_.empty()) continue;
    glUniform3fv(origin, 1, glm::value_ptr(at));
    bodies.quads().draw(spans_, first_vertex);
    for (const QuadSpan& span : spans_) quads += span.count;
  }
  draw_shapes(pass, bodies.quads(), surfaces);
  glDisable(GL_POLYGON_OFFSET_FILL);
  return next == chunks.end();
}

void ShadowCasters::draw_shapes(const ShadowPass& pass, QuadBuffer& quads, Surfaces surfaces) {
  if (shapes_.empty()) return;
  const bool is_textured = !surfaces.textures.empty();
  const GlProgram& program =
      program_of(is_textured ? kDepthHoles | kDepthTextured : unsigned{kDepthHoles});
  const GLint first_vertex = begin_depth(program, pass, quads);
  surfaces.materials.bind(program, kMaterialUnit);
  if (is_textured) surfaces.textures.bind(program, kTextureUnit);
  const GLint origin = glGetUniformLocation(program.get(), "origin");
  const GLint pattern = glGetUniformLocation(program.get(), "pattern");
  for (const ShapesInPass& chunk : shapes_) {
    glUniform3fv(origin, 1, glm::value_ptr(chunk.at));
    glUniform3fv(pattern, 1, glm::value_ptr(chunk.pattern));
    quads.draw(std::span(&chunk.shapes, 1), first_vertex);
  }
}

}  // namespace runstone
