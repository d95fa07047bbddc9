#include "client/render/terrain.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>
#include <utility>

#include "client/render/light_glsl.hpp"
#include "client/render/terrain_units.hpp"

namespace runstone {
namespace {

/// The radius of the inner shadow map, in edges of a chunk. It holds the chunk of the eye as a
/// whole, and those beside it in most places.
constexpr double kShadowEdges = 1.75;

/// The light field around the eye, in voxels: corners are dark and lamps light up to half of it
/// away.
constexpr std::int32_t kFieldWidth = 192, kFieldHeight = 128;

/// The growth of a quad that closes pinholes, as a share of the distance: a thirtieth of a pixel of
/// a picture of 720 lines, or eight times the precision of a rasterizer with 256 steps in a pixel.
constexpr float kSeam = 0.00006F;

/// Returns the voxel that holds a place. Places beyond the limits of the world count as at them.
VoxelPos voxel_at(const glm::dvec3& at) {
  const auto whole = [](double v) {
    return static_cast<std::int32_t>(
        std::floor(std::clamp<double>(v, -kWorldLimit, kWorldLimit - 1)));
  };
  return {whole(at.x), whole(at.y), whole(at.z)};
}

}  // namespace

Terrain::Terrain() : field_(kFieldWidth, kFieldHeight) { set_materials(MaterialTable{}, nullptr); }

void Terrain::set_materials(const MaterialTable& materials, ShapeTablePtr shapes) {
  materials_.set(materials);
  bodies_.set_matt(materials_.matt());
  bodies_.set_shapes(shapes ? std::move(shapes)
                            : std::make_shared<const ShapeTable>(shapes_of(materials)));
  light_codes_ = light_codes(materials);
  surfaces_changed();
}

void Terrain::set_textures(const DrawnTexturesPtr& textures) {
  textures_.set(textures);
  surfaces_changed();
}

void Terrain::surfaces_changed() {
  // Cubes cast the same shadows with every look and every picture.
  const auto& chunks = bodies_.chunks();
  const bool has_shapes = std::any_of(chunks.begin(), chunks.end(), [](const auto& entry) {
    return entry.second.shapes.count != 0;
  });
  if (has_shapes) shadows_.all_changed();
}

void Terrain::upload(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh,
                     const RunChunk* voxels) {
  bodies_.put_chunk(key, edge, mesh);
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
  shadows_changed(key, edge);
}

void Terrain::remove(const ChunkKey& key) {
  if (key.lod == 0) {
    field_.remove(key.at);
    glows_.remove(key.at);
  }
  if (const auto edge = bodies_.remove(key)) shadows_changed(key, *edge);
}

void Terrain::shadows_changed(const ChunkKey& key, std::int32_t edge) {
  const glm::dvec3 min = origin_in_world(key, edge);
  shadows_.changed(min, min + static_cast<double>(edge));
}

void Terrain::update_light(const FrameView& view) {
  if (view.look.quality == Quality::low) return;
  shadows_.update(view.eye, view.light, kShadowEdges * edge_, view.shadow_far, view.look.quality,
                  view.look.exact, [this](ShadowPass& pass, std::size_t quads_max) {
                    return casters_.draw(pass, quads_max, bodies_, {materials_, textures_});
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

void Terrain::begin_pass(const FrameView& view, bool is_transparent,
                         const std::function<void(const GlProgram& program)>& set) {
  const bool is_low = view.look.quality == Quality::low;
  for (unsigned variant = 0; variant < TerrainVariant::kCount; ++variant) {
    if (!visible_.has_variant(is_transparent, variant)) continue;
    TerrainProgram& of_pass = programs_.of(view.look.quality, is_transparent, variant);
    of_pass.cascade = -1;
    glUseProgram(of_pass.gl.get());
    in_use_ = &of_pass;
    set_light(of_pass.gl, view.light);
    glUniformMatrix4fv(glGetUniformLocation(of_pass.gl.get(), "clip"), 1, GL_FALSE,
                       glm::value_ptr(view.clip));
    materials_.bind(of_pass.gl, kMaterialUnit);
    of_pass.first_vertex = bodies_.quads().bind(of_pass.gl, kQuadUnit);
    if (!is_low && (variant & TerrainVariant::kTile) == 0) shadows_.bind(of_pass.gl, kShadowUnit);
    if ((variant & TerrainVariant::kInField) != 0)
      field_texture_.bind(of_pass.gl, kFieldUnit, field_, view.eye);
    if ((variant & TerrainVariant::kTextured) != 0) textures_.bind(of_pass.gl, kTextureUnit);
    set(of_pass.gl);
  }
}

void Terrain::use_for(const VisibleBody& body, const FrameView& view, bool is_transparent) {
  const unsigned variant = body.variants[is_transparent ? 1 : 0];
  TerrainProgram& of_body = programs_.of(view.look.quality, is_transparent, variant);
  if (in_use_ != &of_body) {
    glUseProgram(of_body.gl.get());
    in_use_ = &of_body;
  }
  glUniform3fv(of_body.origin, 1, glm::value_ptr(body.origin));
  glUniform3fv(of_body.pattern, 1, glm::value_ptr(body.pattern));
  glUniform1f(of_body.scale, body.scale);
  if ((variant & TerrainVariant::kTile) != 0)
    glUniform1f(of_body.edge, static_cast<float>(body.body->edge));
  if ((variant & TerrainVariant::kFade) != 0)
    glUniform2fv(of_body.drawn, 1, glm::value_ptr(body.drawn));
  if (view.look.quality == Quality::low || (variant & TerrainVariant::kTile) != 0) return;
  const double half = 0.5 * body.body->edge;
  const glm::dvec3 middle = view.eye + glm::dvec3(body.origin) + half;
  const int cascade = shadows_.cascade_of(middle, half * std::sqrt(3.0));
  if (cascade == of_body.cascade) return;
  of_body.cascade = cascade;
  shadows_.use(of_body.gl, cascade, view.eye);
}

TerrainStats Terrain::draw_opaque(const FrameView& view, const NoiseTexture& noise) {
  TerrainStats stats;
  bodies_.step_fades(view);
  visible_.find(view, bodies_, field_.box(), !textures_.empty(), stats);
  begin_pass(view, false, [&noise](const GlProgram& program) {
    noise.bind(program, kNoiseUnit);
    glUniform1f(glGetUniformLocation(program.get(), "seam"), kSeam);
  });
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  // Chunks are drawn from near to far, so that hidden pixels fail the depth test early.
  for (const VisibleBody& body : visible_.all()) {
    spans_.clear();
    body.body->append_opaque(body.eye, spans_);
    if (spans_.empty()) continue;
    use_for(body, view, false);
    bodies_.quads().draw(spans_, in_use_->first_vertex);
    for (const QuadSpan& span : spans_) stats.quads_drawn += span.count;
  }
  glDisable(GL_CULL_FACE);
  for (const VisibleBody& body : visible_.all()) stats.quads_drawn += body.body->transparent.count;
  stats.chunks_drawn = static_cast<std::uint32_t>(visible_.all().size());
  return stats;
}

void Terrain::draw_transparent(const FrameView& view, GLuint scene_depth) {
  if (!visible_.has_transparent()) return;
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
  for (auto visible = visible_.all().rbegin(); visible != visible_.all().rend(); ++visible) {
    spans_.clear();
    if (visible->body->tree) {
      visible->body->tree->append_back_to_front(visible->eye, visible->body->transparent.first,
                                                spans_);
    } else {
      visible->body->layers.append_back_to_front(visible->eye, spans_, visible->joined_sides);
      const QuadSpan shapes = visible->body->transparent_shapes;
      if (shapes.count != 0) spans_.push_back(shapes);
    }
    if (spans_.empty()) continue;
    use_for(*visible, view, true);
    bodies_.quads().draw(spans_, in_use_->first_vertex);
  }
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Terrain::draw_inspection(const FrameView& view, const Inspection& inspection) {
  if (!inspection.modes.any()) return inspection_.reset();
  if (!inspection_) inspection_.emplace();
  inspection_->begin(inspection, view.clip, view.depth, bodies_.quads(), materials_,
                     view.look.exact);
  for (const VisibleBody& body : visible_.all()) {
    spans_.clear();
    body.body->append_opaque(body.eye, spans_);
    if (body.body->transparent.count != 0) spans_.push_back(body.body->transparent);
    if (spans_.empty()) continue;
    if (inspection_->place(body.key, body.origin, body.body->edge, body.scale))
      bodies_.quads().draw(spans_, inspection_->first_vertex());
  }
  InspectionPainter::end(view.depth);
}

std::uint64_t Terrain::gpu_bytes() const {
  return bodies_.quads().used_bytes() + bodies_.quads().shape_bytes() + field_.byte_size() +
         field_texture_.byte_size() + shadows_.byte_size() + textures_.byte_size();
}

}  // namespace runstone
