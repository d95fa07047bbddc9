#include "client/render/ghost_painter.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <vector>

#include "client/render/depth_range.hpp"
#include "client/render/terrain_body.hpp"
#include "client/render/terrain_glsl.hpp"
#include "client/render/terrain_programs.hpp"
#include "client/render/terrain_units.hpp"

namespace runstone {
namespace {

constexpr const char* kGhostFragmentShader =
    "in vec3 voxel;\n"
    "flat in vec3 normal;\n"
    "flat in vec4 colour;\n"
    "uniform vec4 tint;\n"  // colour, and its share
    "uniform float opaque;\n"
    "uniform float crossed;\n"  // 1: each cell of a face has its diagonals
    "out vec4 fragment;\n"
    "void main() {\n"
    "  vec3 face = abs(normal);\n"
    "  vec2 st = face.x > 0.5 ? voxel.zy : face.y > 0.5 ? voxel.xz : voxel.xy;\n"
    "  vec2 edge = abs(fract(st) - 0.5);\n"
    "  float rim = step(0.46, max(edge.x, edge.y));\n"
    "  rim = max(rim, crossed * step(abs(edge.x - edge.y), 0.03));\n"
    // Where a cell has few pixels, lines between cells would flicker and make patterns of their
    // own. There their mean is drawn instead: lines cover 1 - 0.92 * 0.92 of a face, and diagonals
    // cover 1 - 0.94 * 0.94 of the rest.
    "  float pixel = max(fwidth(st.x), fwidth(st.y));\n"
    "  rim = mix(0.15 + 0.10 * crossed, rim, clamp(1.5 - 3.0 * pixel, 0.0, 1.0));\n"
    "  vec3 c = sqrt(mix(colour.rgb, tint.rgb, tint.a)) * (0.80 + 0.20 * normal.y);\n"
    "  fragment = vec4(c + 0.25 * rim, opaque);\n"
    "}\n";

}  // namespace

GhostPainter::GhostPainter()
    : program_(link_program("ghost", (std::string(kLiquidVariant) + kTerrainVertexShader).c_str(),
                            kGhostFragmentShader)) {}

void GhostPainter::hold(const std::shared_ptr<const ChunkMesh>& mesh, QuadBuffer& quads) {
  if (!mesh || mesh->empty()) return;
  const auto [found, is_new] = held_.try_emplace(mesh.get());
  GhostQuads& ghost = found->second;
  ghost.is_used = true;
  if (!is_new) return;
  ghost.mesh = mesh;
  std::vector<Quad> all = mesh->opaque.quads;
  for (const std::vector<Quad>* some :
       {&mesh->transparent.quads, &mesh->shapes.opaque, &mesh->shapes.transparent})
    all.insert(all.end(), some->begin(), some->end());
  ghost.quads = {quads.add(all), static_cast<std::uint32_t>(all.size())};
}

void GhostPainter::hold_only(std::span<const GhostChunk> ghosts, QuadBuffer& quads) {
  for (auto& [mesh, ghost] : held_) ghost.is_used = false;
  for (const GhostChunk& ghost : ghosts) {
    hold(ghost.placed, quads);
    hold(ghost.removed, quads);
  }
  std::erase_if(held_, [&quads](const auto& entry) {
    if (!entry.second.is_used) quads.remove(entry.second.quads);
    return !entry.second.is_used;
  });
}

void GhostPainter::draw(const FrameView& view, std::span<const GhostChunk> ghosts,
                        const MaterialTextures& materials, QuadBuffer& quads) {
  // Quads are copied first, because a copy may replace the buffer that is bound.
  hold_only(ghosts, quads);
  if (held_.empty()) return;
  glUseProgram(program_.get());
  // A ghost of removed voxels has the faces of the world, and must lie in front of them.
  glUniformMatrix4fv(glGetUniformLocation(program_.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(in_front(view.clip)));
  glUniform1f(glGetUniformLocation(program_.get(), "seam"), 0);
  const GLint scale = glGetUniformLocation(program_.get(), "scale");
  materials.bind(program_, kMaterialUnit);
  const GLint first_vertex = quads.bind(program_, kQuadUnit);
  const auto pulse = static_cast<float>(0.08 * std::sin(view.look.seconds * 4));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  const auto draw = [&](const GhostChunk& ghost, const std::shared_ptr<const ChunkMesh>& mesh,
                        const glm::vec4& tint, float opaque) {
    if (!mesh || mesh->empty()) return;
    // Removed voxels also have another form, because not everybody can tell red from green.
    const float crossed = mesh == ghost.removed ? 1 : 0;
    glUniform1f(glGetUniformLocation(program_.get(), "crossed"), crossed);
    const glm::dvec3 shift{ghost.shift.x, ghost.shift.y, ghost.shift.z};
    const glm::vec3 at(origin_in_world(ghost.key, ghost.edge) + shift - view.eye);
    const glm::vec3 pattern = pattern_of(ghost.key, ghost.edge);
    glUniform1f(scale, static_cast<float>(1U << ghost.key.lod));
    glUniform3fv(glGetUniformLocation(program_.get(), "origin"), 1, glm::value_ptr(at));
    glUniform3fv(glGetUniformLocation(program_.get(), "pattern"), 1, glm::value_ptr(pattern));
    glUniform4fv(glGetUniformLocation(program_.get(), "tint"), 1, glm::value_ptr(tint));
    glUniform1f(glGetUniformLocation(program_.get(), "opaque"), opaque);
    const std::array<QuadSpan, 1> span = {held_.at(mesh.get()).quads};
    quads.draw(span, first_vertex);
  };
  for (const GhostChunk& ghost : ghosts) {
    if (ghost.tint) {
      const auto channel = [&](std::size_t i) {
        return static_cast<float>((*ghost.tint)[i]) / 255;
      };
      const glm::vec4 tint{channel(0), channel(1), channel(2), 0.8F};
      draw(ghost, ghost.removed, tint * glm::vec4{0.5F, 0.5F, 0.5F, 1.1F}, 0.38F + pulse);
      draw(ghost, ghost.placed, tint, 0.50F + pulse);
      continue;
    }
    draw(ghost, ghost.removed, {0.80F, 0.02F, 0.02F, 0.85F}, 0.42F + pulse);
    draw(ghost, ghost.placed, {1, 1, 1, 0.08F}, 0.62F + pulse);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

}  // namespace runstone
