#include "client/render/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <limits>
#include <string>
#include <utility>

#include "client/far/child_bits.hpp"
#include "client/render/terrain_glsl.hpp"
#include "common/shapes/shape_table.hpp"

namespace runstone {
namespace {

/// The radius of the inner shadow map, in edges of a chunk. It holds the chunk of the eye as a
/// whole, and those beside it in most places.
constexpr double kShadowEdges = 1.75;

/// Coordinates fixed to the world are taken modulo this number of voxels, so that a float holds
/// them precisely.
constexpr std::int32_t kPattern = 8192;

/// The light field around the eye, in voxels: corners are dark and lamps light up to half of it
/// away.
constexpr std::int32_t kFieldWidth = 192, kFieldHeight = 128;

/// The growth of a quad that closes pinholes, as a share of the distance: a thirtieth of a pixel of
/// a picture of 720 lines, or eight times the precision of a rasterizer with 256 steps in a pixel.
constexpr float kSeam = 0.00006F;

// Texture units.
constexpr GLint kMaterialUnit = 0, kQuadUnit = 2, kFieldUnit = 3, kNoiseUnit = 4, kShadowUnit = 5,
                kDepthUnit = 6;
static_assert(kDepthUnit < QuadBuffer::kShapeUnit);
constexpr GLint kTextureUnit = 14;
// TextureArray::bind() takes two units. A fragment shader has at least 16.
static_assert(QuadBuffer::kShapeUnit < kTextureUnit && kTextureUnit + 1 < 16);

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

constexpr const char* kGhostFragmentShader =
    "in vec3 voxel;\n"
    "flat in vec3 normal;\n"
    "flat in vec4 colour;\n"
    "uniform vec4 tint;\n"  // colour, and its share
    "uniform float opaque;\n"
    "out vec4 fragment;\n"
    "void main() {\n"
    "  vec3 face = abs(normal);\n"
    "  vec2 st = face.x > 0.5 ? voxel.zy : face.y > 0.5 ? voxel.xz : voxel.xy;\n"
    "  vec2 edge = abs(fract(st) - 0.5);\n"
    "  float rim = step(0.46, max(edge.x, edge.y));\n"
    // Where a cell has few pixels, lines between cells would flicker and make patterns of their
    // own. There their mean is drawn instead: lines cover 1 - 0.92 * 0.92 of a face.
    "  float pixel = max(fwidth(st.x), fwidth(st.y));\n"
    "  rim = mix(0.15, rim, clamp(1.5 - 3.0 * pixel, 0.0, 1.0));\n"
    "  vec3 c = sqrt(mix(colour.rgb, tint.rgb, tint.a)) * (0.80 + 0.20 * normal.y);\n"
    "  fragment = vec4(c + 0.25 * rim, opaque);\n"
    "}\n";

constexpr const char* kLiquidVariant = "#define RUNSTONE_LIQUID\n";

std::string variant_of(const char* shader, Quality quality, bool is_transparent, bool is_tile,
                       bool has_field, bool is_fine, bool has_fog, bool is_fading) {
  std::string out;
  if (is_transparent) out += kLiquidVariant;
  if (quality != Quality::low) out += "#define RUNSTONE_DEPTH\n";
  if (quality != Quality::low && !is_tile) out += "#define RUNSTONE_SHADOWS\n";
  if (is_tile) out += "#define RUNSTONE_TILE\n";
  if (has_field) out += "#define RUNSTONE_FIELD\n";
  if (is_fine) out += "#define RUNSTONE_FINE\n";
  if (has_fog) out += "#define RUNSTONE_FOG\n";
  if (is_fading) out += "#define RUNSTONE_FADE\n";
  return out + shader;
}

/// Returns the definitions of texture_glsl.hpp.
std::string texture_definitions(bool is_textured, bool has_holes, bool has_all_holes) {
  std::string out;
  if (is_textured) out += "#define RUNSTONE_TEXTURES\n";
  if (has_holes) out += "#define RUNSTONE_HOLES\n";
  if (has_all_holes) out += "#define RUNSTONE_ALL_HOLES\n";
  return out;
}

/// Return the distance of the eye from the nearest place of a cube, 0 inside it, and from the
/// farthest one. `min` is relative to the eye.
double nearest_of(const glm::dvec3& min, double edge) {
  return glm::length(glm::max(glm::max(min, -(min + edge)), 0.0));
}
double farthest_of(const glm::dvec3& min, double edge) {
  return glm::length(glm::max(glm::abs(min), glm::abs(min + edge)));
}

glm::dvec3 origin_in_world(const ChunkKey& key, std::int32_t edge) {
  const VoxelPos o = origin_of(key.at, edge);
  return {o.x, o.y, o.z};
}

/// Returns the voxel that holds a place. Places beyond the limits of the world count as at them.
VoxelPos voxel_at(const glm::dvec3& at) {
  const auto whole = [](double v) {
    return static_cast<std::int32_t>(
        std::floor(std::clamp<double>(v, -kWorldLimit, kWorldLimit - 1)));
  };
  return {whole(at.x), whole(at.y), whole(at.z)};
}

glm::vec3 pattern_of(const ChunkKey& key, std::int32_t edge) {
  const VoxelPos o = origin_of(key.at, edge);
  const auto wrap = [](std::int32_t v) { return static_cast<float>(v & (kPattern - 1)); };
  return {wrap(o.x), wrap(o.y), wrap(o.z)};
}

}  // namespace

Terrain::Terrain()
    : ghost_program_(link_program("ghost",
                                  (std::string(kLiquidVariant) + kTerrainVertexShader).c_str(),
                                  kGhostFragmentShader)),
      field_(kFieldWidth, kFieldHeight) {
  set_materials(MaterialTable{}, nullptr);
}

void Terrain::set_materials(const MaterialTable& materials, ShapeTablePtr shapes) {
  materials_.set(materials);
  shapes_ = shapes ? std::move(shapes) : std::make_shared<const ShapeTable>(shapes_of(materials));
  quads_.set_shapes(*shapes_);
  light_codes_ = light_codes(materials);
}

Terrain::Chunk Terrain::add_chunk(std::int32_t edge, const ChunkMesh& mesh) {
  const auto count_of = [](std::span<const Quad> quads) {
    return static_cast<std::uint32_t>(quads.size());
  };
  const auto append = [this](std::span<const Quad> quads) {
    staged_.insert(staged_.end(), quads.begin(), quads.end());
  };
  // The transparent quads of cubes and shapes, which are ordered together.
  std::vector<Quad> joined;
  std::span<const Quad> transparent(mesh.transparent.quads);
  if (!mesh.shapes.transparent.empty()) {
    joined = mesh.transparent.quads;
    joined.insert(joined.end(), mesh.shapes.transparent.begin(), mesh.shapes.transparent.end());
    transparent = joined;
  }
  auto tree = TransparentTree::build(transparent, *shapes_);
  if (tree) transparent = tree->pieces();
  // Both passes lie in one span, so that a chunk has one range of the buffer.
  staged_ = mesh.opaque.quads;
  append(mesh.shapes.opaque);
  append(transparent);
  const std::uint32_t first = quads_.add(staged_);
  Chunk out;
  out.edge = edge;
  out.quads = {first, count_of(staged_)};
  out.opaque = QuadSpans(mesh.opaque, edge, first);
  out.shapes = {first + count_of(mesh.opaque.quads), count_of(mesh.shapes.opaque)};
  out.transparent = {out.shapes.first + out.shapes.count, count_of(transparent)};
  if (!tree) {
    out.layers = QuadSpans(mesh.transparent, edge, out.transparent.first);
    out.transparent_shapes = {out.transparent.first + count_of(mesh.transparent.quads),
                              count_of(mesh.shapes.transparent)};
  }
  out.tree = std::move(tree);
  return out;
}

Terrain::Tile Terrain::add_tile(std::int32_t edge, const TileMesh& mesh) {
  // Drivers take some time for each copy to the GPU. So all bodies are copied together.
  staged_.clear();
  const auto stage = [this](const ChunkMesh& body) {
    for (const QuadLayers* pass : {&body.opaque, &body.transparent})
      staged_.insert(staged_.end(), pass->quads.begin(), pass->quads.end());
  };
  stage(mesh.whole);
  for (const ChunkMesh& octant : mesh.octants) stage(octant);
  std::uint32_t next = quads_.add(staged_);
  const auto body_of = [&next](std::int32_t side, const ChunkMesh& body) {
    Chunk out;
    const auto opaque_count = static_cast<std::uint32_t>(body.opaque.quads.size());
    const auto transparent_count = static_cast<std::uint32_t>(body.transparent.quads.size());
    out.edge = side;
    out.quads = {next, opaque_count + transparent_count};
    out.opaque = QuadSpans(body.opaque, side, next);
    out.transparent = {next + opaque_count, transparent_count};
    out.layers = QuadSpans(body.transparent, side, next + opaque_count);
    next += out.quads.count;
    return out;
  };
  Tile out;
  out.whole = body_of(edge, mesh.whole);
  for (const ChunkMesh& octant : mesh.octants)
    out.octants.push_back(octant.empty() ? Chunk{} : body_of(edge / 2, octant));
  return out;
}

void Terrain::upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
                     const RunChunk* voxels) {
  if (const auto before = chunks_.find(key); before != chunks_.end()) {
    quads_.remove(before->second.quads);
    chunks_.erase(before);
  }
  if (!mesh.empty()) chunks_.emplace(key, add_chunk(edge, mesh));
  cover(key, true);
  if (key.lod == 0) {
    if (voxels != nullptr) {
      LightChunk light = light_chunk(*voxels, light_codes_);
      glows_.set(key.at, edge, lamp_glows(light.codes));
      field_.set(key.at, edge, std::move(light));
    } else {
      field_.remove(key.at);
      glows_.remove(key.at);
    }
  }
  edge_ = std::max(edge_, edge);
  const glm::dvec3 min = origin_in_world(key, edge);
  shadows_.changed(min, min + static_cast<double>(edge));
}

void Terrain::upload_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) {
  if (const auto before = tiles_.find(key); before != tiles_.end()) {
    remove_quads(before->second);
    tiles_.erase(before);
  }
  cover(key, mesh.empty() || !mesh.octants.empty());
  if (mesh.empty()) return;
  tiles_.emplace(key, add_tile(edge, mesh));
}

void Terrain::remove_quads(const Tile& tile) {
  quads_.remove(tile.whole.quads);
  for (const Chunk& octant : tile.octants) quads_.remove(octant.quads);
}

void Terrain::cover(const ChunkKey& key, bool is_open) {
  if (fades_.is_leaving(key)) end_fade(key);
  const bool replaces = has_fades_ && !cover_.shows(key) && is_octant_drawn(key);
  cover_.put(key, is_open);
  if (replaces && is_drawn_whole(key)) fades_.begin(key, true);
}

bool Terrain::is_octant_drawn(const ChunkKey& key) const {
  if (key.lod == kTileLevelMax) return false;
  const TileParts parts = cover_.parts(tile_parent(key));
  return parts.is_whole || (parts.octants & child_bit(key)) != 0;
}

bool Terrain::is_drawn_whole(const ChunkKey& key) const {
  return key.lod == 0 ? cover_.shows(key) : cover_.parts(key).is_whole;
}

void Terrain::end_fade(const ChunkKey& key) {
  fades_.end(key);
  const auto left = leaving_.find(key);
  if (left == leaving_.end()) return;
  quads_.remove(left->second.quads);
  leaving_.erase(left);
}

void Terrain::step_fades(const FrameView& view) {
  has_fades_ = !view.look.exact && view.look.quality != Quality::low;
  if (fades_.empty()) return;
  for (const ChunkKey& key : fades_.advance(view.look.seconds)) end_fade(key);
  for (const ChunkKey& key : fades_.keys()) {
    const bool goes_on = fades_.is_leaving(key) ? is_octant_drawn(key) : is_drawn_whole(key);
    if (!has_fades_ || !goes_on || !has_octants(tile_parent(key))) end_fade(key);
  }
}

bool Terrain::has_octants(const ChunkKey& tile) const {
  const auto found = tiles_.find(tile);
  return found != tiles_.end() && !found->second.octants.empty();
}

bool Terrain::has_appearing_octant(const ChunkKey& key, const Tile& tile) const {
  for (unsigned i = 0; i < tile.octants.size() && !fades_.empty(); ++i) {
    if (fades_.is_leaving(tile_child(key, i))) return true;
  }
  return false;
}

void Terrain::remove(const ChunkKey& key) {
  const bool was_drawn = has_fades_ && is_drawn_whole(key);
  end_fade(key);
  cover_.remove(key);
  const bool fades = was_drawn && is_octant_drawn(key) && fades_.begin(key, false);
  if (const auto tile = tiles_.find(key); tile != tiles_.end()) {
    if (fades) {
      leaving_.emplace(key, std::move(tile->second.whole));
      tile->second.whole = {};
    }
    remove_quads(tile->second);
    tiles_.erase(tile);
    return;
  }
  if (key.lod == 0) {
    field_.remove(key.at);
    glows_.remove(key.at);
  }
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return;
  const glm::dvec3 min = origin_in_world(key, found->second.edge);
  shadows_.changed(min, min + static_cast<double>(found->second.edge));
  if (fades) {
    leaving_.emplace(key, std::move(found->second));
  } else {
    quads_.remove(found->second.quads);
  }
  chunks_.erase(found);
}

Terrain::Program& Terrain::program(Quality quality, bool is_transparent, unsigned variant) {
  Program& out = programs_[static_cast<std::size_t>(quality)][is_transparent ? 1 : 0][variant];
  if (!out.gl) {
    const char* fragment = is_transparent ? kTransparentFragmentShader : kTerrainFragmentShader;
    const bool is_textured = (variant & kTextured) != 0;
    const std::string textures =
        texture_definitions(is_textured, (variant & kHoles) != 0, is_textured && is_transparent);
    const auto text = [&](const char* shader) {
      return textures + variant_of(shader, quality, is_transparent, (variant & kTile) != 0,
                                   (variant & kInField) != 0, (variant & kFine) != 0,
                                   (variant & kInFog) != 0, (variant & kFade) != 0);
    };
    out.gl = link_program(is_transparent ? "transparent" : "terrain",
                          text(kTerrainVertexShader).c_str(), text(fragment).c_str());
    out.origin = glGetUniformLocation(out.gl.get(), "origin");
    out.pattern = glGetUniformLocation(out.gl.get(), "pattern");
    out.scale = glGetUniformLocation(out.gl.get(), "scale");
    out.edge = glGetUniformLocation(out.gl.get(), "edge");
    out.drawn = glGetUniformLocation(out.gl.get(), "drawn");
  }
  return out;
}

void Terrain::update_light(const FrameView& view) {
  if (view.look.quality == Quality::low) return;
  shadows_.update(view.eye, view.light, kShadowEdges * edge_, view.shadow_far, view.look.quality,
                  view.look.exact, [this](ShadowPass& pass, std::size_t quads_max) {
                    return draw_depth(pass, quads_max);
                  });
  relit_.clear();
  field_.update(voxel_at(view.eye), view.look.exact, relit_);
  field_texture_.copy(field_, relit_);
}

glm::vec4 Terrain::light_at(const FrameView& view, const glm::dvec3& at) const {
  const VoxelPos voxel = voxel_at(at);
  if (view.look.quality == Quality::low || !field_.box().contains(voxel)) return {0, 0, 0, 1};
  const LightLevels levels = field_.levels_at(voxel);
  const auto channel = [levels](unsigned shift) {
    return static_cast<float>(levels >> shift & 255U) / static_cast<float>(kLightMax);
  };
  return {channel(0) * channel(0), channel(8) * channel(8), channel(16) * channel(16), channel(24)};
}

const GlProgram& Terrain::depth_program(unsigned variant) {
  GlProgram& out = depth_programs_[variant];
  if (!out) {
    const std::string holes =
        texture_definitions((variant & kDepthTextured) != 0, (variant & kDepthHoles) != 0, false);
    out = link_program("depth", (holes + kDepthVertexShader).c_str(),
                       (holes + kDepthFragmentShader).c_str());
  }
  return out;
}

GLint Terrain::begin_depth(const GlProgram& program, const ShadowPass& pass) {
  glUseProgram(program.get());
  glUniformMatrix4fv(glGetUniformLocation(program.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(pass.clip));
  // Light must not leak through the T-junctions of merged quads.
  constexpr float kDepthSeam = 0.05F;  // of a pixel
  glUniform1f(glGetUniformLocation(program.get(), "seam"), kDepthSeam * pass.pixel);
  return quads_.bind(program, kQuadUnit);
}

bool Terrain::draw_depth(ShadowPass& pass, std::size_t quads_max) {
  const GlProgram& program = depth_program(0);
  const GLint first_vertex = begin_depth(program, pass);
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
  shapes_in_pass_.clear();
  auto next = pass.drawn_to ? chunks_.upper_bound(*pass.drawn_to) : chunks_.begin();
  for (; next != chunks_.end() && quads < quads_max; ++next) {
    const auto& [key, chunk] = *next;
    pass.drawn_to = key;
    const glm::vec3 at(origin_in_world(key, chunk.edge) - pass.middle);
    if (!frustum.may_see(at, at + static_cast<float>(chunk.edge))) continue;
    if (chunk.shapes.count != 0)
      shapes_in_pass_.push_back({chunk.shapes, at, pattern_of(key, chunk.edge)});
    spans_.clear();
    chunk.opaque.append_facing(sun, spans_);
    quads += chunk.shapes.count;
    if (spans_.empty()) continue;
    glUniform3fv(origin, 1, glm::value_ptr(at));
    quads_.draw(spans_, first_vertex);
    for (const QuadSpan& span : spans_) quads += span.count;
  }
  draw_depth_of_shapes(pass);
  glDisable(GL_POLYGON_OFFSET_FILL);
  return next == chunks_.end();
}

void Terrain::draw_depth_of_shapes(const ShadowPass& pass) {
  if (shapes_in_pass_.empty()) return;
  const bool is_textured = !textures_.empty();
  const GlProgram& program =
      depth_program(is_textured ? kDepthHoles | kDepthTextured : unsigned{kDepthHoles});
  const GLint first_vertex = begin_depth(program, pass);
  materials_.bind(program, kMaterialUnit);
  if (is_textured) textures_.bind(program, kTextureUnit);
  const GLint origin = glGetUniformLocation(program.get(), "origin");
  const GLint pattern = glGetUniformLocation(program.get(), "pattern");
  for (const ShapesInPass& chunk : shapes_in_pass_) {
    glUniform3fv(origin, 1, glm::value_ptr(chunk.at));
    glUniform3fv(pattern, 1, glm::value_ptr(chunk.pattern));
    quads_.draw(std::span(&chunk.shapes, 1), first_vertex);
  }
}

void Terrain::add_visible(Visible body, unsigned variant, float gone) {
  const bool has_transparent = body.chunk->transparent.count != 0;
  body.variants = {variant, variant};
  if (gone > 0) {
    body.variants = {variant | kFade, variant | kFade};
    body.drawn = {gone, 1};
  } else if (has_transparent && fades_.has(body.key)) {
    // Water that is blended twice is too dark. So the finer one has the pixels that the octant lacks.
    body.variants[1] |= kFade;
    body.drawn = {0, fades_.octant_gone(body.key)};
  }
  if (body.chunk->shapes.count != 0) body.variants[0] |= kHoles;
  if (!textures_.empty()) {
    body.variants[0] |= kTextured;
    body.variants[1] |= kTextured;
  }
  has_variant_[0][body.variants[0]] = true;
  if (has_transparent) has_variant_[1][body.variants[1]] = true;
  has_transparent_ = has_transparent_ || has_transparent;
  visible_.push_back(body);
}

void Terrain::find_visible(const FrameView& view, TerrainStats& stats) {
  step_fades(view);
  visible_.clear();
  has_variant_ = {};
  has_transparent_ = false;
  // Grain fades out before a pixel is larger than this part of a voxel (kTerrainFragmentShader).
  const double fine_distance = 0.0625 / view.pixel;
  const Frustum frustum(view.clip, view.depth.is_reversed());
  const auto add = [&](const ChunkKey& key, const Chunk& chunk) {
    const glm::dvec3 origin = origin_in_world(key, chunk.edge) - view.eye;
    const glm::vec3 at(origin);
    const auto edge = static_cast<float>(chunk.edge);
    if (!frustum.may_see(at, at + edge)) {
      ++stats.chunks_culled;
      return;
    }
    const glm::vec3 centre = at + 0.5F * edge;
    unsigned variant = 0;
    if (view.look.quality != Quality::low &&
        !intersect(box_of(key.at, chunk.edge), field_.box()).empty())
      variant |= kInField;
    if (nearest_of(origin, chunk.edge) < fine_distance) variant |= kFine;
    if (farthest_of(origin, chunk.edge) > double{view.light.fog_start}) variant |= kInFog;
    Visible body{&chunk, at, pattern_of(key, chunk.edge), {}, glm::dot(centre, centre)};
    body.eye = {-origin.x, -origin.y, -origin.z};
    body.key = key;
    add_visible(body, variant, 0);
  };
  for (const auto& [key, chunk] : chunks_) {
    if (tiles_.empty() || cover_.shows(key)) add(key, chunk);
  }
  for (const auto& [key, chunk] : leaving_) {
    if (key.lod == 0) add(key, chunk);
  }
  find_visible_tiles(view, frustum, stats);
  std::sort(visible_.begin(), visible_.end(),
            [](const Visible& a, const Visible& b) { return a.distance2 < b.distance2; });
}

std::uint8_t Terrain::joined_sides(const ChunkKey& key, std::uint8_t octants) const {
  std::uint8_t out = 0;
  for (const Direction d :
       {Direction::neg_x, Direction::pos_x, Direction::neg_z, Direction::pos_z}) {
    const unsigned across = 1U << static_cast<unsigned>(axis_of(d));
    const ChunkKey beside{key.lod, neighbour(key.at, d)};
    bool is_joined = true;
    for (unsigned i = 0; i < kTileChildren && is_joined; ++i) {
      if (!has_child(octants, i)) continue;
      const bool is_at_side = ((i & across) != 0) == is_positive(d);
      // A whole tile meets the tile beside it with the octants at this side only.
      if (octants == kAllChildren && !is_at_side) continue;
      const TileParts parts = cover_.parts(is_at_side ? beside : key);
      is_joined = parts.is_whole || has_child(parts.octants, i ^ across);
    }
    if (is_joined) out = static_cast<std::uint8_t>(out | 1U << static_cast<unsigned>(d));
  }
  return out;
}

void Terrain::find_visible_tiles(const FrameView& view, const Frustum& frustum,
                                 TerrainStats& stats) {
  const auto add = [&](const ChunkKey& key, const Chunk& part, std::uint8_t octants,
                       const glm::dvec3& at, const glm::vec3& pattern, float gone) {
    if (part.quads.count == 0) return;
    const double scale = std::ldexp(1.0, key.lod), width = scale * part.edge;
    if (nearest_of(at, width) > view.far ||
        !frustum.may_see(glm::vec3(at), glm::vec3(at + width))) {
      ++stats.chunks_culled;
      return;
    }
    const glm::vec3 centre(at + 0.5 * width);
    unsigned variant = kTile;
    if (farthest_of(at, width) > double{view.light.fog_start}) variant |= kInFog;
    ++stats.tile_parts_drawn;
    const glm::dvec3 eye = -at / scale;
    Visible body{&part, glm::vec3(at), pattern, {eye.x, eye.y, eye.z}, glm::dot(centre, centre)};
    body.scale = static_cast<float>(scale);
    if (part.transparent.count != 0) body.joined_sides = joined_sides(key, octants);
    body.key = key;
    add_visible(body, variant, gone);
  };
  const auto corner_of = [&](const ChunkKey& key, std::int32_t edge) {
    // The limits of the world hold for its voxels, so the origin in voxels of the tile is exact.
    const VoxelPos first = origin_of(key.at, edge);
    return glm::dvec3{first.x, first.y, first.z} * std::ldexp(1.0, key.lod) - view.eye;
  };
  for (const auto& [key, tile] : tiles_) {
    const double side = std::ldexp(1.0, key.lod) * tile.whole.edge;
    const glm::dvec3 corner = corner_of(key, tile.whole.edge);
    if (!frustum.may_see(glm::vec3(corner), glm::vec3(corner + side))) {
      ++stats.chunks_culled;
      continue;
    }
    TileParts parts = cover_.parts(key);
    if (parts.is_whole && has_appearing_octant(key, tile)) parts = {false, kAllChildren};
    const glm::vec3 pattern = pattern_of(key, tile.whole.edge);
    if (parts.is_whole) add(key, tile.whole, kAllChildren, corner, pattern, 0);
    for (unsigned i = 0; i < tile.octants.size(); ++i) {
      const ChunkKey child = tile_child(key, i);
      const bool dissolves = fades_.is_coming(child);
      if (!has_child(parts.octants, i) && !dissolves) continue;
      const glm::dvec3 place{i & 1U, i >> 1U & 1U, i >> 2U};
      add(key, tile.octants[i], static_cast<std::uint8_t>(1U << i), corner + place * (0.5 * side),
          pattern + glm::vec3(place * (0.5 * tile.whole.edge)), fades_.octant_gone(child));
    }
  }
  for (const auto& [key, part] : leaving_) {
    if (key.lod > 0)
      add(key, part, kAllChildren, corner_of(key, part.edge), pattern_of(key, part.edge), 0);
  }
}

void Terrain::begin_pass(const FrameView& view, bool is_transparent,
                         const std::function<void(const GlProgram& program)>& set) {
  const bool is_low = view.look.quality == Quality::low;
  for (unsigned variant = 0; variant < kVariants; ++variant) {
    if (!has_variant_[is_transparent ? 1 : 0][variant]) continue;
    Program& of_pass = program(view.look.quality, is_transparent, variant);
    of_pass.cascade = -1;
    glUseProgram(of_pass.gl.get());
    in_use_ = &of_pass;
    set_light(of_pass.gl, view.light);
    glUniformMatrix4fv(glGetUniformLocation(of_pass.gl.get(), "clip"), 1, GL_FALSE,
                       glm::value_ptr(view.clip));
    materials_.bind(of_pass.gl, kMaterialUnit);
    of_pass.first_vertex = quads_.bind(of_pass.gl, kQuadUnit);
    if (!is_low && (variant & kTile) == 0) shadows_.bind(of_pass.gl, kShadowUnit);
    if ((variant & kInField) != 0) field_texture_.bind(of_pass.gl, kFieldUnit, field_, view.eye);
    if ((variant & kTextured) != 0) textures_.bind(of_pass.gl, kTextureUnit);
    set(of_pass.gl);
  }
}

void Terrain::use_for(const Visible& chunk, const FrameView& view, bool is_transparent) {
  const unsigned variant = chunk.variants[is_transparent ? 1 : 0];
  Program& of_chunk = program(view.look.quality, is_transparent, variant);
  if (in_use_ != &of_chunk) {
    glUseProgram(of_chunk.gl.get());
    in_use_ = &of_chunk;
  }
  glUniform3fv(of_chunk.origin, 1, glm::value_ptr(chunk.origin));
  glUniform3fv(of_chunk.pattern, 1, glm::value_ptr(chunk.pattern));
  glUniform1f(of_chunk.scale, chunk.scale);
  if ((variant & kTile) != 0) glUniform1f(of_chunk.edge, static_cast<float>(chunk.chunk->edge));
  if ((variant & kFade) != 0) glUniform2fv(of_chunk.drawn, 1, glm::value_ptr(chunk.drawn));
  if (view.look.quality == Quality::low || (variant & kTile) != 0) return;
  const double half = 0.5 * chunk.chunk->edge;
  const glm::dvec3 middle = view.eye + glm::dvec3(chunk.origin) + half;
  const int cascade = shadows_.cascade_of(middle, half * std::sqrt(3.0));
  if (cascade == of_chunk.cascade) return;
  of_chunk.cascade = cascade;
  shadows_.use(of_chunk.gl, cascade, view.eye);
}

TerrainStats Terrain::draw_opaque(const FrameView& view, const NoiseTexture& noise) {
  TerrainStats stats;
  find_visible(view, stats);
  begin_pass(view, false, [&noise](const GlProgram& program) {
    noise.bind(program, kNoiseUnit);
    glUniform1f(glGetUniformLocation(program.get(), "seam"), kSeam);
  });
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  // Chunks are drawn from near to far, so that hidden pixels fail the depth test early.
  for (const Visible& chunk : visible_) {
    spans_.clear();
    chunk.chunk->append_opaque(chunk.eye, spans_);
    if (spans_.empty()) continue;
    use_for(chunk, view, false);
    quads_.draw(spans_, in_use_->first_vertex);
    for (const QuadSpan& span : spans_) stats.quads_drawn += span.count;
  }
  glDisable(GL_CULL_FACE);
  for (const Visible& chunk : visible_) stats.quads_drawn += chunk.chunk->transparent.count;
  stats.chunks_drawn = static_cast<std::uint32_t>(visible_.size());
  return stats;
}

void Terrain::draw_transparent(const FrameView& view, GLuint scene_depth) {
  if (!has_transparent_) return;
  glActiveTexture(GL_TEXTURE0 + kDepthUnit);
  glBindTexture(GL_TEXTURE_2D, scene_depth);
  begin_pass(view, true, [&view](const GlProgram& program) {
    const auto at = [&program](const char* name) {
      return glGetUniformLocation(program.get(), name);
    };
    glUniform1f(at("seconds"), static_cast<float>(view.look.seconds));
    glUniform1f(at("seam"), 0);  // quads that overlap would be blended twice
    glUniform3fv(at("distance_terms"), 1, glm::value_ptr(view.depth.distance_terms()));
    glUniform1i(at("scene_depth"), kDepthUnit);
  });
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  // Water is also seen from below, so both sides are drawn.
  for (auto chunk = visible_.rbegin(); chunk != visible_.rend(); ++chunk) {
    spans_.clear();
    if (chunk->chunk->tree) {
      chunk->chunk->tree->append_back_to_front(chunk->eye, chunk->chunk->transparent.first, spans_);
    } else {
      chunk->chunk->layers.append_back_to_front(chunk->eye, spans_, chunk->joined_sides);
      const QuadSpan shapes = chunk->chunk->transparent_shapes;
      if (shapes.count != 0) spans_.push_back(shapes);
    }
    if (spans_.empty()) continue;
    use_for(*chunk, view, true);
    quads_.draw(spans_, in_use_->first_vertex);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Terrain::draw_inspection(const FrameView& view, const Inspection& inspection) {
  if (!inspection.modes.any()) return inspection_.reset();
  if (!inspection_) inspection_.emplace();
  inspection_->begin(inspection, view.clip, view.depth, quads_, materials_, view.look.exact);
  for (const Visible& chunk : visible_) {
    spans_.clear();
    chunk.chunk->append_opaque(chunk.eye, spans_);
    if (chunk.chunk->transparent.count != 0) spans_.push_back(chunk.chunk->transparent);
    if (spans_.empty()) continue;
    if (inspection_->place(chunk.key, chunk.origin, chunk.chunk->edge, chunk.scale))
      quads_.draw(spans_, inspection_->first_vertex());
  }
  InspectionPainter::end(view.depth);
}

QuadSpan Terrain::ghost_quads(const std::shared_ptr<const ChunkMesh>& mesh) {
  const auto [found, is_new] = ghosts_.try_emplace(mesh.get());
  GhostQuads& ghost = found->second;
  ghost.is_used = true;
  if (is_new) {
    ghost.mesh = mesh;
    std::vector<Quad> quads = mesh->opaque.quads;
    for (const std::vector<Quad>* some :
         {&mesh->transparent.quads, &mesh->shapes.opaque, &mesh->shapes.transparent})
      quads.insert(quads.end(), some->begin(), some->end());
    ghost.quads = {quads_.add(quads), static_cast<std::uint32_t>(quads.size())};
  }
  return ghost.quads;
}

void Terrain::draw_ghosts(const FrameView& view, std::span<const GhostChunk> ghosts) {
  for (auto& [mesh, ghost] : ghosts_) ghost.is_used = false;
  // Quads are copied first, because a copy may replace the buffer that is bound.
  for (const GhostChunk& ghost : ghosts) {
    if (ghost.placed && !ghost.placed->empty()) ghost_quads(ghost.placed);
    if (ghost.removed && !ghost.removed->empty()) ghost_quads(ghost.removed);
  }
  std::erase_if(ghosts_, [this](const auto& entry) {
    if (!entry.second.is_used) quads_.remove(entry.second.quads);
    return !entry.second.is_used;
  });
  if (ghosts_.empty()) return;
  glUseProgram(ghost_program_.get());
  // A ghost of removed voxels has the faces of the world, and must lie in front of them.
  glUniformMatrix4fv(glGetUniformLocation(ghost_program_.get(), "clip"), 1, GL_FALSE,
                     glm::value_ptr(in_front(view.clip)));
  glUniform1f(glGetUniformLocation(ghost_program_.get(), "seam"), 0);
  const GLint scale = glGetUniformLocation(ghost_program_.get(), "scale");
  materials_.bind(ghost_program_, kMaterialUnit);
  const GLint first_vertex = quads_.bind(ghost_program_, kQuadUnit);
  const auto pulse = static_cast<float>(0.08 * std::sin(view.look.seconds * 4));
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_CULL_FACE);
  glDepthMask(GL_FALSE);
  const auto draw = [&](const GhostChunk& ghost, const std::shared_ptr<const ChunkMesh>& mesh,
                        const glm::vec4& tint, float opaque) {
    if (!mesh || mesh->empty()) return;
    const glm::dvec3 shift{ghost.shift.x, ghost.shift.y, ghost.shift.z};
    const glm::vec3 at(origin_in_world(ghost.key, ghost.edge) + shift - view.eye);
    const glm::vec3 pattern = pattern_of(ghost.key, ghost.edge);
    glUniform1f(scale, static_cast<float>(1U << ghost.key.lod));
    glUniform3fv(glGetUniformLocation(ghost_program_.get(), "origin"), 1, glm::value_ptr(at));
    glUniform3fv(glGetUniformLocation(ghost_program_.get(), "pattern"), 1, glm::value_ptr(pattern));
    glUniform4fv(glGetUniformLocation(ghost_program_.get(), "tint"), 1, glm::value_ptr(tint));
    glUniform1f(glGetUniformLocation(ghost_program_.get(), "opaque"), opaque);
    const std::array<QuadSpan, 1> span = {ghosts_.at(mesh.get()).quads};
    quads_.draw(span, first_vertex);
  };
  for (const GhostChunk& ghost : ghosts) {
    if (ghost.tint) {
      const auto channel = [&](std::size_t i) {
        return static_cast<float>((*ghost.tint)[i]) / 255;
      };
      const glm::vec4 tint{channel(0), channel(1), channel(2), 0.7F};
      draw(ghost, ghost.removed, tint * glm::vec4{0.5F, 0.5F, 0.5F, 1.2F}, 0.22F);
      draw(ghost, ghost.placed, tint, 0.30F);
      continue;
    }
    draw(ghost, ghost.removed, {0.80F, 0.02F, 0.02F, 0.85F}, 0.42F + pulse);
    draw(ghost, ghost.placed, {1, 1, 1, 0.08F}, 0.62F + pulse);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
}

std::uint64_t Terrain::gpu_bytes() const {
  return quads_.used_bytes() + quads_.shape_bytes() + field_.byte_size() +
         field_texture_.byte_size() + shadows_.byte_size() + textures_.byte_size();
}

}  // namespace runstone
