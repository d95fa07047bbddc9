#include "client/far/far_tiles.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {
namespace {

/// An entry of a map takes about this much memory besides the runs.
constexpr std::size_t kEntryBytes = 96;
/// More shared tiles are not kept. A peer could otherwise fill the memory with materials.
constexpr std::size_t kSharedMax = 64;

std::size_t bytes_of(const RunChunk& tile) {
  return kEntryBytes + (tile.is_uniform() ? 0 : sizeof(RunChunk) + tile.runs.byte_size());
}

}  // namespace

void FarTiles::set_view(const View& view, std::int32_t edge) {
  if (edge != edge_) clear();
  edge_ = edge;
  view_ = view;
  const CoordLimit world = CoordLimit::of(edge);
  for (auto tile = tiles_.begin(); tile != tiles_.end();)
    tile = has_key(view, world, tile->first) ? std::next(tile) : drop(tile);
}

void FarTiles::clear() {
  for (auto tile = tiles_.begin(); tile != tiles_.end();) tile = drop(tile);
  uniform_.clear();
}

bool FarTiles::receive(const ChunkKey& key, RunChunk tile) {
  if (tile.extent != Extent::cube(static_cast<unsigned>(edge_))) return false;
  if (tile.is_uniform()) return receive_uniform(key, material_at(tile, {0, 0, 0}));
  return keep(key, std::make_shared<const RunChunk>(std::move(tile)));
}

bool FarTiles::receive_uniform(const ChunkKey& key, Material material) {
  if (edge_ == 0) return false;
  auto& shared = uniform_[material];
  if (!shared) {
    shared = std::make_shared<const RunChunk>(
        uniform_chunk(Extent::cube(static_cast<unsigned>(edge_)), material));
  }
  TilePtr tile = shared;
  if (uniform_.size() > kSharedMax) uniform_.clear();
  return keep(key, std::move(tile));
}

bool FarTiles::keep(const ChunkKey& key, TilePtr tile) {
  RUNSTONE_ASSERT(key.lod > 0);
  if (!view_ || !has_key(*view_, CoordLimit::of(edge_), key)) return false;
  TilePtr& held = tiles_[key];
  if (held) {
    // A tile is often sent again with the same voxels, after an edit that it does not show.
    if (held == tile || *held == *tile) return true;
    count(*held, false);
  }
  count(*tile, true);
  held = std::move(tile);
  changed_.insert(key);
  if (is_empty(*held)) drop_below(key);
  return true;
}

std::map<ChunkKey, TilePtr>::iterator FarTiles::drop(std::map<ChunkKey, TilePtr>::iterator tile) {
  count(*tile->second, false);
  changed_.insert(tile->first);
  return tiles_.erase(tile);
}

void FarTiles::drop_below(const ChunkKey& key) {
  if (key.lod <= 1) return;
  const CoordLimit world = CoordLimit::of(edge_);
  for (unsigned i = 0; i < kTileChildren; ++i) {
    const ChunkKey child = tile_child(key, i);
    // A view has the parents of all its tiles, so nothing below a child outside of it is held.
    if (!has_key(*view_, world, child)) continue;
    if (const auto held = tiles_.find(child); held != tiles_.end()) drop(held);
    drop_below(child);
  }
}

void FarTiles::count(const RunChunk& tile, bool is_added) {
  const std::size_t bytes = bytes_of(tile), solid = is_empty(tile) ? 0 : 1;
  bytes_ = is_added ? bytes_ + bytes : bytes_ - bytes;
  solid_count_ = is_added ? solid_count_ + solid : solid_count_ - solid;
}

TilePtr FarTiles::find(const ChunkKey& key) const {
  const auto held = tiles_.find(key);
  return held == tiles_.end() ? nullptr : held->second;
}

FarTiles::Missing FarTiles::missing() const {
  Missing out;
  if (!view_ || tile_levels(*view_) == 0) return out;
  const CoordLimit world = CoordLimit::of(edge_);
  const std::uint8_t levels = tile_levels(*view_);
  const ChunkCoord centre = tile_at(view_->centre, levels);
  const std::int32_t radius = view_->radius_h;
  for (std::int32_t dx = -radius; dx <= radius; ++dx) {
    for (std::int32_t dz = -radius; dz <= radius; ++dz) {
      for (std::int32_t dy = -kTileRadiusV; dy <= kTileRadiusV; ++dy) {
        const ChunkKey root{levels, {centre.x + dx, centre.y + dy, centre.z + dz}};
        if (has_key(*view_, world, root) && !tiles_.contains(root)) ++out.roots;
      }
    }
  }
  for (const auto& [key, tile] : tiles_) {
    if (key.lod <= 1 || is_empty(*tile)) continue;
    for (unsigned i = 0; i < kTileChildren; ++i) {
      const ChunkKey child = tile_child(key, i);
      if (has_key(*view_, world, child) && !tiles_.contains(child)) ++out.others;
    }
  }
  return out;
}

std::vector<ChunkKey> FarTiles::drain_changes() {
  std::vector<ChunkKey> out(changed_.begin(), changed_.end());
  changed_.clear();
  return out;
}

}  // namespace runstone
