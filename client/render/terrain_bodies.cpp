#include "client/render/terrain_bodies.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "client/far/child_bits.hpp"
#include "common/mesh/quad.hpp"

namespace runstone {

void TerrainBodies::set_shapes(ShapeTablePtr shapes) {
  shapes_ = std::move(shapes);
  quads_.set_shapes(*shapes_);
}

void TerrainBodies::set_matt(const std::vector<bool>& materials) {
  bool has_fewer = false;
  for (std::size_t i = 0; i < matt_.size(); ++i)
    has_fewer = has_fewer || (matt_[i] && (i >= materials.size() || !materials[i]));
  matt_ = materials;
  if (!has_fewer) return;
  for (auto& [key, chunk] : chunks_) chunk.is_glossy = true;
  for (auto& [key, body] : leaving_) body.is_glossy = true;
  for (auto& [key, tile] : tiles_) {
    tile.whole.is_glossy = true;
    for (TerrainBody& octant : tile.octants) octant.is_glossy = true;
  }
}

bool TerrainBodies::is_glossy(std::span<const Quad> quads) const {
  return std::ranges::any_of(quads, [this](Quad quad) {
    const Material material = unpack(quad).material;
    return material >= matt_.size() || !matt_[material];
  });
}

void TerrainBodies::put_chunk(const ChunkKey& key, std::int32_t edge, const ChunkMesh& mesh) {
  if (const auto before = chunks_.find(key); before != chunks_.end()) {
    quads_.remove(before->second.quads);
    chunks_.erase(before);
  }
  if (!mesh.empty()) chunks_.emplace(key, add_chunk(edge, mesh));
  cover_with(key, true);
}

void TerrainBodies::put_tile(const ChunkKey& key, std::int32_t edge, const TileMesh& mesh) {
  if (const auto before = tiles_.find(key); before != tiles_.end()) {
    remove_quads(before->second);
    tiles_.erase(before);
  }
  cover_with(key, mesh.empty() || !mesh.octants.empty());
  if (mesh.empty()) return;
  tiles_.emplace(key, add_tile(edge, mesh));
}

std::optional<std::int32_t> TerrainBodies::remove(const ChunkKey& key) {
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
    return std::nullopt;
  }
  const auto found = chunks_.find(key);
  if (found == chunks_.end()) return std::nullopt;
  const std::int32_t edge = found->second.edge;
  if (fades) {
    leaving_.emplace(key, std::move(found->second));
  } else {
    quads_.remove(found->second.quads);
  }
  chunks_.erase(found);
  return edge;
}

TerrainBody TerrainBodies::add_chunk(std::int32_t edge, const ChunkMesh& mesh) {
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
  TerrainBody out;
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
  out.is_glossy = is_glossy(mesh.opaque.quads) || is_glossy(mesh.shapes.opaque);
  return out;
}

TerrainTile TerrainBodies::add_tile(std::int32_t edge, const TileMesh& mesh) {
  // Drivers take some time for each copy to the GPU. So all bodies are copied together.
  staged_.clear();
  const auto stage = [this](const ChunkMesh& body) {
    for (const QuadLayers* pass : {&body.opaque, &body.transparent})
      staged_.insert(staged_.end(), pass->quads.begin(), pass->quads.end());
  };
  stage(mesh.whole);
  for (const ChunkMesh& octant : mesh.octants) stage(octant);
  std::uint32_t next = quads_.add(staged_);
  const auto body_of = [this, &next](std::int32_t side, const ChunkMesh& body) {
    TerrainBody out;
    const auto opaque_count = static_cast<std::uint32_t>(body.opaque.quads.size());
    const auto transparent_count = static_cast<std::uint32_t>(body.transparent.quads.size());
    out.edge = side;
    out.quads = {next, opaque_count + transparent_count};
    out.opaque = QuadSpans(body.opaque, side, next);
    out.transparent = {next + opaque_count, transparent_count};
    out.layers = QuadSpans(body.transparent, side, next + opaque_count);
    out.is_glossy = is_glossy(body.opaque.quads);
    next += out.quads.count;
    return out;
  };
  TerrainTile out;
  out.whole = body_of(edge, mesh.whole);
  for (const ChunkMesh& octant : mesh.octants)
    out.octants.push_back(octant.empty() ? TerrainBody{} : body_of(edge / 2, octant));
  return out;
}

void TerrainBodies::remove_quads(const TerrainTile& tile) {
  quads_.remove(tile.whole.quads);
  for (const TerrainBody& octant : tile.octants) quads_.remove(octant.quads);
}

void TerrainBodies::cover_with(const ChunkKey& key, bool is_open) {
  if (fades_.is_leaving(key)) end_fade(key);
  const bool replaces = has_fades_ && !cover_.shows(key) && is_octant_drawn(key);
  cover_.put(key, is_open);
  if (replaces && is_drawn_whole(key)) fades_.begin(key, true);
}

bool TerrainBodies::is_octant_drawn(const ChunkKey& key) const {
  if (key.lod == kTileLevelMax) return false;
  const TileParts parts = cover_.parts(tile_parent(key));
  return parts.is_whole || (parts.octants & child_bit(key)) != 0;
}

bool TerrainBodies::is_drawn_whole(const ChunkKey& key) const {
  return key.lod == 0 ? cover_.shows(key) : cover_.parts(key).is_whole;
}

void TerrainBodies::end_fade(const ChunkKey& key) {
  fades_.end(key);
  const auto left = leaving_.find(key);
  if (left == leaving_.end()) return;
  quads_.remove(left->second.quads);
  leaving_.erase(left);
}

void TerrainBodies::step_fades(const FrameView& view) {
  has_fades_ = !view.look.exact && view.look.quality != Quality::low;
  if (fades_.empty()) return;
  for (const ChunkKey& key : fades_.advance(view.look.seconds)) end_fade(key);
  for (const ChunkKey& key : fades_.keys()) {
    const bool goes_on = fades_.is_leaving(key) ? is_octant_drawn(key) : is_drawn_whole(key);
    if (!has_fades_ || !goes_on || !has_octants(tile_parent(key))) end_fade(key);
  }
}

bool TerrainBodies::has_octants(const ChunkKey& tile) const {
  const auto found = tiles_.find(tile);
  return found != tiles_.end() && !found->second.octants.empty();
}

bool TerrainBodies::has_appearing_octant(const ChunkKey& key, const TerrainTile& tile) const {
  for (unsigned i = 0; i < tile.octants.size() && !fades_.empty(); ++i) {
    if (fades_.is_leaving(tile_child(key, i))) return true;
  }
  return false;
}

}  // namespace runstone
