#include "client/render/inspection_painter.hpp"

#include <algorithm>
#include <array>
#include <glm/gtc/type_ptr.hpp>

#include "client/render/liquid_surface.hpp"
#include "client/render/quad_glsl.hpp"
#include "client/render/texel_store.hpp"

namespace runstone {
namespace {

constexpr GLint kInspectedQuadUnit = 0, kRunStartUnit = 1, kInspectedMaterialUnit = 2;
constexpr std::uint32_t kRunWordsAtFirst = 1U << 16;

constexpr const char* kInspectionVertexShader = RUNSTONE_QUAD_GLSL RUNSTONE_LOWERED_GLSL
    "uniform mat4 clip;\n"
    "uniform vec3 origin;\n"  // of the chunk or tile, minus eye
    "uniform float scale;\n"  // world units of a voxel
    "uniform sampler2D palette, looks;\n"
    "out vec3 local;\n"  // the middle of the face's voxel, in the chunk
    "out vec2 side;\n"   // -1 .. 1 along both sides of the quad
    "flat out vec3 normal;\n"
    "void main() {\n"
    "  QuadCorner c = quad_corner();\n"
    "  vec3 n = abs(c.normal);\n"
    "  side = vec2(dot(c.outward, n.zxy), dot(c.outward, n.yzx));\n"
    "  local = c.at - c.normal * 0.5;\n"
    "  normal = c.normal;\n"
    "  ivec2 row = ivec2(c.material & 255u, c.material >> 8);\n"
    "  vec3 at = origin + scale * c.at;\n"
    "  at.y -= lowered(c, texelFetch(palette, row, 0), texelFetch(looks, row, 0));\n"
    "  gl_Position = clip * vec4(at, 1.0);\n"
    "}\n";

constexpr const char* kInspectionFragmentShader =
    "in vec3 local;\n"
    "in vec2 side;\n"
    "flat in vec3 normal;\n"
    "uniform float wireframe, flash;\n"  // 0: not shown
    "uniform vec4 tint;\n"               // of the axis order, and its share
    "uniform uvec4 layers[3];\n"         // bit i of axis a: layer i flashes
    "uniform usampler2D run_starts;\n"
    "uniform int first_word;\n"  // of the chunk in run_starts; negative: not shown
    "uniform int edge;\n"
    "uniform ivec3 fast, middle, slow;\n"  // unit vectors of the axis order
    "out vec4 fragment;\n" RUNSTONE_TEXEL_GLSL
    "void lay(vec3 colour, float alpha) {\n"
    "  fragment = vec4(colour * alpha, alpha) + fragment * (1.0 - alpha);\n"
    "}\n"
    "bool in_layers(int axis, int at) {\n"
    "  return ((layers[axis][at >> 5] >> (at & 31)) & 1u) != 0u;\n"
    "}\n"
    "int index_of(ivec3 v) {\n"
    "  ivec3 weight = fast + edge * (middle + edge * slow);\n"
    "  return v.x * weight.x + v.y * weight.y + v.z * weight.z;\n"
    "}\n"
    // The end of the chunk ends a run.
    "bool run_starts_at(int i) {\n"
    "  if (i >= edge * edge * edge) return true;\n"
    "  return ((texelFetch(run_starts, texel_place(first_word + (i >> 5)), 0).x >> (i & 31)) &\n"
    "          1u) != 0u;\n"
    "}\n"
    "void main() {\n"
    "  fragment = vec4(0.0);\n"
    "  ivec3 voxel = clamp(ivec3(floor(local)), ivec3(0), ivec3(edge - 1));\n"
    "  vec3 per_pixel = fwidth(local);\n"
    "  vec2 side_per_pixel = fwidth(side);\n"
    "  lay(tint.rgb, tint.a);\n"
    "  if (flash > 0.0 && (in_layers(0, voxel.x) || in_layers(1, voxel.y) ||\n"
    "                      in_layers(2, voxel.z))) {\n"
    "    lay(vec3(1.0, 0.82, 0.15), 0.7 * flash);\n"
    "  }\n"
    "  if (first_word >= 0) {\n"
    "    vec3 along = vec3(fast);\n"
    "    int here = index_of(voxel);\n"
    "    float towards = dot(normal, along);\n"
    "    if (towards != 0.0) {\n"
    // This face lies across the fastest axis: it is the end of a run, or the run goes on behind it.
    "      bool ends = run_starts_at(towards > 0.0 ? here + 1 : here);\n"
    "      lay(vec3(0.1, 0.9, 1.0), ends ? 0.45 : 0.0);\n"
    "    } else {\n"
    // A line where the run of this voxel begins. It is drawn while a voxel is some pixels wide.
    "      float width = dot(per_pixel, along);\n"
    "      float pixels = fract(dot(local, along)) / width;\n"
    "      float line = run_starts_at(here) ? 1.0 - smoothstep(1.0, 2.0, pixels) : 0.0;\n"
    "      lay(vec3(0.0, 0.75, 0.95), line * clamp(1.6 - 4.0 * width, 0.0, 1.0));\n"
    "    }\n"
    "  }\n"
    // Edges of quads. Quads of few pixels are outlined lightly, so that they do not become black.
    "  vec2 pixels = (1.0 - abs(side)) / side_per_pixel;\n"
    "  vec2 size = 2.0 / side_per_pixel;\n"
    "  vec2 line = (1.0 - smoothstep(0.5, 1.3, pixels)) * clamp(size * 0.2 - 0.3, 0.1, 1.0);\n"
    "  lay(vec3(0.04, 0.05, 0.08), wireframe * 0.9 * max(line.x, line.y));\n"
    "}\n";

glm::ivec3 unit_vector(Axis axis) {
  glm::ivec3 out{0};
  out[static_cast<int>(axis)] = 1;
  return out;
}

template <class Rows>
auto row_of(const Rows& rows, const ChunkKey& key) {
  const auto at = std::lower_bound(rows.begin(), rows.end(), key,
                                   [](const auto& row, const ChunkKey& k) { return row.key < k; });
  return at != rows.end() && at->key == key ? &*at : nullptr;
}

}  // namespace

InspectionPainter::InspectionPainter()
    : program_(link_program("inspection", kInspectionVertexShader, kInspectionFragmentShader)),
      bits_(TexelFormat::r32, kRunWordsAtFirst) {}

void InspectionPainter::upload(const InspectedChunk& chunk, Bits& bits) {
  if (bits.words != 0) bits_.remove(bits.first, bits.words);
  const std::vector<std::uint32_t> words = run_start_bits(*chunk.voxels);
  bits.voxels = chunk.voxels;
  bits.words = static_cast<std::uint32_t>(words.size());
  bits.first = bits_.add(words.data(), bits.words);
}

void InspectionPainter::update_bits(bool exact) {
  for (auto& [key, bits] : chunks_) bits.is_used = false;
  int uploads = 0;
  for (const InspectedChunk& chunk : shown_->chunks) {
    if (!chunk.shows_runs || chunk.voxels->volume() % 32 != 0) continue;
    const auto known = chunks_.find(chunk.key);
    const bool is_known = known != chunks_.end();
    if (is_known && known->second.voxels == chunk.voxels) {
      known->second.is_used = true;
      continue;
    }
    if (exact || uploads < kUploadsMax) {
      ++uploads;
      Bits& bits = chunks_[chunk.key];
      upload(chunk, bits);
      bits.is_used = true;
    } else if (is_known) {
      known->second.is_used = true;  // a little old
    }
  }
  std::erase_if(chunks_, [this](const auto& entry) {
    if (!entry.second.is_used) bits_.remove(entry.second.first, entry.second.words);
    return !entry.second.is_used;
  });
}

void InspectionPainter::begin(const Inspection& inspection, const glm::mat4& clip,
                              const DepthRange& depth, const QuadBuffer& quads,
                              const MaterialTextures& materials, bool exact) {
  shown_ = &inspection;
  update_bits(exact);
  glUseProgram(program_.get());
  glUniformMatrix4fv(at("clip"), 1, GL_FALSE, glm::value_ptr(in_front(clip)));
  glUniform1f(at("wireframe"), inspection.modes[InspectionMode::wireframe] ? 1.0F : 0.0F);
  glActiveTexture(GL_TEXTURE0 + kRunStartUnit);
  glBindTexture(GL_TEXTURE_2D, bits_.texture());
  glUniform1i(at("run_starts"), kRunStartUnit);
  materials.bind(program_, kInspectedMaterialUnit);
  first_vertex_ = quads.bind(program_, kInspectedQuadUnit);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glDepthFunc(depth.not_farther());
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
}

bool InspectionPainter::place(const ChunkKey& key, const glm::vec3& origin, std::int32_t edge,
                              float scale) {
  const InspectedChunk* const chunk = row_of(shown_->chunks, key);
  const bool shows_order = shown_->modes[InspectionMode::orders] && chunk != nullptr;
  const bool shows_runs = chunk != nullptr && chunks_.contains(key);
  const bool flashes = place_flash(key);
  if (!shown_->modes[InspectionMode::wireframe] && !shows_order && !shows_runs && !flashes)
    return false;
  glUniform3fv(at("origin"), 1, glm::value_ptr(origin));
  glUniform1i(at("edge"), edge);
  glUniform1f(at("scale"), scale);
  glm::vec4 tint{0};
  if (shows_order) {
    const InspectionColour colour = colour_of(chunk->voxels->order);
    tint = {colour[0] / 255.0F, colour[1] / 255.0F, colour[2] / 255.0F, 0.5F};
  }
  glUniform4fv(at("tint"), 1, glm::value_ptr(tint));
  if (!shows_runs) {
    glUniform1i(at("first_word"), -1);
    return true;
  }
  const Bits& bits = chunks_.at(key);
  glUniform1i(at("first_word"), static_cast<GLint>(bits.first));
  const auto axes = axes_of(bits.voxels->order);
  glUniform3iv(at("fast"), 1, glm::value_ptr(unit_vector(axes[0])));
  glUniform3iv(at("middle"), 1, glm::value_ptr(unit_vector(axes[1])));
  glUniform3iv(at("slow"), 1, glm::value_ptr(unit_vector(axes[2])));
  return true;
}

bool InspectionPainter::place_flash(const ChunkKey& key) const {
  const FlashedLayers* const flash = row_of(shown_->flashes, key);
  glUniform1f(at("flash"), flash != nullptr ? flash->strength : 0.0F);
  if (flash == nullptr) return false;
  std::array<std::uint32_t, 12> words{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t layer = 0; layer < kSideMax; ++layer) {
      if (flash->layers.layer[axis][layer]) words[axis * 4 + layer / 32] |= 1U << (layer % 32);
    }
  }
  glUniform4uiv(at("layers"), 3, words.data());
  return true;
}

void InspectionPainter::end(const DepthRange& depth) {
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDepthMask(GL_TRUE);
  glDepthFunc(depth.nearer());
}

}  // namespace runstone
