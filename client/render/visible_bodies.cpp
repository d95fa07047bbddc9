#include "client/render/visible_bodies.hpp"

#include <algorithm>
#include <cmath>

#include "client/far/child_bits.hpp"

namespace runstone {
namespace {

/// Return the distance of the eye from the nearest place of a cube, 0 inside it, and from the
/// farthest one. `min` is relative to the eye.
double nearest_of(const glm::dvec3& min, double edge) {
  return glm::length(glm::max(glm::max(min, -(min + edge)), 0.0));
}
double farthest_of(const glm::dvec3& min, double edge) {
  return glm::length(glm::max(glm::abs(min), glm::abs(min + edge)));
}

}  // namespace

void VisibleBodies::find(const FrameView& view, const TerrainBodies& bodies, const VoxelBox& field,
                         bool is_textured, TerrainStats& stats) {
  bodies_ = &bodies;
  is_textured_ = is_textured;
  visible_.clear();
  has_variant_ = {};
  has_transparent_ = false;
  const Frustum frustum(view.clip, view.depth.is_reversed());
  find_chunks(view, frustum, field, stats);
  find_tiles(view, frustum, stats);
  std::sort(visible_.begin(), visible_.end(),
            [](const VisibleBody& a, const VisibleBody& b) { return a.distance2 < b.distance2; });
}

void VisibleBodies::find_chunks(const FrameView& view, const Frustum& frustum,
                                const VoxelBox& field, TerrainStats& stats) {
  // Grain fades out before a pixel is larger than this part of a voxel (kTerrainFragmentShader).
  const double fine_distance = 0.0625 / view.pixel;
  const auto add_chunk = [&](const ChunkKey& key, const TerrainBody& chunk) {
    const glm::dvec3 origin = origin_in_world(key, chunk.edge) - view.eye;
    const glm::vec3 at(origin);
    const auto edge = static_cast<float>(chunk.edge);
    if (!frustum.may_see(at, at + edge)) {
      ++stats.chunks_culled;
      return;
    }
    const glm::vec3 centre = at + 0.5F * edge;
    unsigned variant = 0;
    if (view.look.quality != Quality::low && !intersect(box_of(key.at, chunk.edge), field).empty())
      variant |= TerrainVariant::kInField;
    if (nearest_of(origin, chunk.edge) < fine_distance) variant |= TerrainVariant::kFine;
    if (farthest_of(origin, chunk.edge) > double{view.light.fog_start})
      variant |= TerrainVariant::kInFog;
    VisibleBody body{&chunk, at, pattern_of(key, chunk.edge), {}, glm::dot(centre, centre)};
    body.eye = {-origin.x, -origin.y, -origin.z};
    body.key = key;
    add(body, variant, 0);
  };
  for (const auto& [key, chunk] : bodies_->chunks()) {
    if (bodies_->tiles().empty() || bodies_->cover().shows(key)) add_chunk(key, chunk);
  }
  for (const auto& [key, chunk] : bodies_->leaving()) {
    if (key.lod == 0) add_chunk(key, chunk);
  }
}

void VisibleBodies::add(VisibleBody body, unsigned variant, float gone) {
  const bool has_transparent = body.body->transparent.count != 0;
  body.variants = {variant, variant};
  if (gone > 0) {
    body.variants = {variant | TerrainVariant::kFade, variant | TerrainVariant::kFade};
    body.drawn = {gone, 1};
  } else if (has_transparent && bodies_->fades().has(body.key)) {
    // Water that is blended twice is too dark. So the finer body has the pixels that the octant
    // lacks.
    body.variants[1] |= TerrainVariant::kFade;
    body.drawn = {0, bodies_->fades().octant_gone(body.key)};
  }
  if (body.body->shapes.count != 0) body.variants[0] |= TerrainVariant::kHoles;
  if (body.body->is_glossy) body.variants[0] |= TerrainVariant::kGlossy;
  if (is_textured_) {
    body.variants[0] |= TerrainVariant::kTextured;
    body.variants[1] |= TerrainVariant::kTextured;
  }
  has_variant_[0][body.variants[0]] = true;
  if (has_transparent) has_variant_[1][body.variants[1]] = true;
  has_transparent_ = has_transparent_ || has_transparent;
  visible_.push_back(body);
}

std::uint8_t VisibleBodies::joined_sides(const ChunkKey& key, std::uint8_t octants) const {
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
      const TileParts parts = bodies_->cover().parts(is_at_side ? beside : key);
      is_joined = parts.is_whole || has_child(parts.octants, i ^ across);
    }
    if (is_joined) out = static_cast<std::uint8_t>(out | 1U << static_cast<unsigned>(d));
  }
  return out;
}

void VisibleBodies::find_tiles(const FrameView& view, const Frustum& frustum, TerrainStats& stats) {
  const auto add_part = [&](const ChunkKey& key, const TerrainBody& part, std::uint8_t octants,
                            const glm::dvec3& at, const glm::vec3& pattern, float gone) {
    if (part.quads.count == 0) return;
    const double scale = std::ldexp(1.0, key.lod), width = scale * part.edge;
    if (nearest_of(at, width) > view.far ||
        !frustum.may_see(glm::vec3(at), glm::vec3(at + width))) {
      ++stats.chunks_culled;
      return;
    }
    const glm::vec3 centre(at + 0.5 * width);
    unsigned variant = TerrainVariant::kTile;
    if (farthest_of(at, width) > double{view.light.fog_start}) variant |= TerrainVariant::kInFog;
    ++stats.tile_parts_drawn;
    const glm::dvec3 eye = -at / scale;
    VisibleBody body{
        &part, glm::vec3(at), pattern, {eye.x, eye.y, eye.z}, glm::dot(centre, centre)};
    body.scale = static_cast<float>(scale);
    if (part.transparent.count != 0) body.joined_sides = joined_sides(key, octants);
    body.key = key;
    add(body, variant, gone);
  };
  const auto corner_of = [&](const ChunkKey& key, std::int32_t edge) {
    // The limits of the world hold for its voxels, so the origin in voxels of the tile is exact.
    const VoxelPos first = origin_of(key.at, edge);
    return glm::dvec3{first.x, first.y, first.z} * std::ldexp(1.0, key.lod) - view.eye;
  };
  for (const auto& [key, tile] : bodies_->tiles()) {
    const double side = std::ldexp(1.0, key.lod) * tile.whole.edge;
    const glm::dvec3 corner = corner_of(key, tile.whole.edge);
    if (!frustum.may_see(glm::vec3(corner), glm::vec3(corner + side))) {
      ++stats.chunks_culled;
      continue;
    }
    TileParts parts = bodies_->cover().parts(key);
    if (parts.is_whole && bodies_->has_appearing_octant(key, tile)) parts = {false, kAllChildren};
    const glm::vec3 pattern = pattern_of(key, tile.whole.edge);
    if (parts.is_whole) add_part(key, tile.whole, kAllChildren, corner, pattern, 0);
    for (unsigned i = 0; i < tile.octants.size(); ++i) {
      const ChunkKey child = tile_child(key, i);
      const bool dissolves = bodies_->fades().is_coming(child);
      if (!has_child(parts.octants, i) && !dissolves) continue;
      const glm::dvec3 place{i & 1U, i >> 1U & 1U, i >> 2U};
      add_part(key, tile.octants[i], static_cast<std::uint8_t>(1U << i),
               corner + place * (0.5 * side), pattern + glm::vec3(place * (0.5 * tile.whole.edge)),
               bodies_->fades().octant_gone(child));
    }
  }
  for (const auto& [key, part] : bodies_->leaving()) {
    if (key.lod > 0)
      add_part(key, part, kAllChildren, corner_of(key, part.edge), pattern_of(key, part.edge), 0);
  }
}

}  // namespace runstone
