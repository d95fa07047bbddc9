#include "client/far/far_tiles.hpp"

#include <algorithm>
#include <utility>

#include "common/core/assert.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {
namespace {

/// An entry of a map takes about this much memory besides the runs.
constexpr std::size_t kEntryBytes = 128;
/// More shared tiles are not kept. A peer could otherwise fill the memory with materials.
constexpr std::size_t kSharedMax = 64;

std::size_t bytes_of(const RunChunk& tile) {
  return kEntryBytes + (tile.is_uniform() ? 0 : sizeof(Chunk) + tile.runs.byte_size());
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

void FarTiles::reopen(std::uint32_t rules, const std::function<bool(const Version&)>& trusts) {
  const bool are_same_rules = rules != 0 && rules == rules_;
  rules_ = rules;
  looked_for_.reset();
  for (auto& [key, tile] : tiles_) {
    tile.is_vouched = false;
    tile.can_be_kept = tile.can_be_kept && are_same_rules && trusts(tile.source->version);
  }
}

bool FarTiles::receive(const ChunkKey& key, Chunk tile) {
  if (tile.voxels.extent != Extent::cube(static_cast<unsigned>(edge_))) return false;
  if (tile.voxels.is_uniform()) return receive_uniform(key, material_at(tile.voxels, {0, 0, 0}));
  Entry entry;
  entry.source = std::make_shared<const Chunk>(std::move(tile));
  entry.voxels = TilePtr(entry.source, &entry.source->voxels);
  entry.is_vouched = true;
  // The server marks a tile that it will replace soon by the digest 0.
  entry.can_be_kept = rules_ != 0 && entry.source->digest != Digest{};
  return keep(key, std::move(entry));
}

bool FarTiles::receive_uniform(const ChunkKey& key, Material material) {
  if (edge_ == 0) return false;
  auto& shared = uniform_[material];
  if (!shared) {
    shared = std::make_shared<const RunChunk>(
        uniform_chunk(Extent::cube(static_cast<unsigned>(edge_)), material));
  }
  Entry entry;
  entry.voxels = shared;
  entry.is_vouched = true;
  if (uniform_.size() > kSharedMax) uniform_.clear();
  return keep(key, std::move(entry));
}

bool FarTiles::receive_not_modified(const ChunkKey& key, Sequence seq) {
  const auto entry = tiles_.find(key);
  if (entry == tiles_.end() || !entry->second.source || entry->second.source->version.seq != seq)
    return false;
  entry->second.is_vouched = true;
  return true;
}

bool FarTiles::adopt(const ChunkKey& key, ChunkPtr tile) {
  const bool fits = rules_ != 0 && !tile->voxels.is_uniform() &&
                    tile->voxels.extent == Extent::cube(static_cast<unsigned>(edge_));
  if (!fits || tiles_.contains(key) || is_below_empty(key)) return false;
  Entry entry;
  entry.voxels = TilePtr(tile, &tile->voxels);
  entry.source = std::move(tile);
  entry.can_be_kept = entry.is_cached = true;
  return keep(key, std::move(entry));
}

bool FarTiles::keep(const ChunkKey& key, Entry tile) {
  RUNSTONE_ASSERT(key.lod > 0);
  if (!view_ || !has_key(*view_, CoordLimit::of(edge_), key)) return false;
  Entry& entry = tiles_[key];
  if (entry.voxels) {
    // A tile is often sent again with the same voxels, after an edit that it does not show.
    if (entry.voxels == tile.voxels || *entry.voxels == *tile.voxels) {
      tile.voxels = entry.voxels;
      entry = std::move(tile);
      return true;
    }
    count(*entry.voxels, false);
  }
  entry = std::move(tile);
  count(*entry.voxels, true);
  changed_.insert(key);
  if (is_empty(*entry.voxels)) drop_below(key);
  return true;
}

FarTiles::Tiles::iterator FarTiles::drop(Tiles::iterator tile) {
  count(*tile->second.voxels, false);
  changed_.insert(tile->first);
  return tiles_.erase(tile);
}

bool FarTiles::is_below_empty(const ChunkKey& key) const {
  ChunkKey above = key;
  while (above.lod < kTileLevelMax) {
    above = tile_parent(above);
    const auto entry = tiles_.find(above);
    // Only the nearest tile above that is here counts: the ones above it are not empty.
    if (entry != tiles_.end()) return is_empty(*entry->second.voxels);
  }
  return false;
}

void FarTiles::drop_below(const ChunkKey& key) {
  if (key.lod <= 1) return;
  const CoordLimit world = CoordLimit::of(edge_);
  for (unsigned i = 0; i < kTileChildren; ++i) {
    const ChunkKey child = tile_child(key, i);
    // A view has the parents of all its tiles, so nothing below a child outside of it is here.
    if (!has_key(*view_, world, child)) continue;
    if (const auto entry = tiles_.find(child); entry != tiles_.end()) drop(entry);
    drop_below(child);
  }
}

void FarTiles::count(const RunChunk& tile, bool is_added) {
  const std::size_t bytes = bytes_of(tile), solid = is_empty(tile) ? 0 : 1;
  bytes_ = is_added ? bytes_ + bytes : bytes_ - bytes;
  solid_count_ = is_added ? solid_count_ + solid : solid_count_ - solid;
}

TilePtr FarTiles::find(const ChunkKey& key) const {
  const auto entry = tiles_.find(key);
  return entry == tiles_.end() ? nullptr : entry->second.voxels;
}

void FarTiles::for_each_claimable(
    const std::function<bool(const ChunkKey&, const Chunk&)>& visit) const {
  for (const auto& [key, tile] : tiles_) {
    if (!tile.is_vouched && tile.can_be_kept && !visit(key, *tile.source)) return;
  }
}

std::vector<std::pair<ChunkKey, ChunkPtr>> FarTiles::take_for_cache(std::size_t count_max) {
  std::vector<std::pair<ChunkKey, ChunkPtr>> out;
  for (auto& [key, tile] : tiles_) {
    if (out.size() >= count_max) break;
    if (!tile.is_for_cache()) continue;
    tile.is_cached = true;
    out.emplace_back(key, tile.source);
  }
  return out;
}

bool FarTiles::has_for_cache() const {
  return std::any_of(tiles_.begin(), tiles_.end(),
                     [](const auto& entry) { return entry.second.is_for_cache(); });
}

std::vector<ChunkKey> FarTiles::take_not_held() {
  std::vector<ChunkKey> out;
  if (!view_ || rules_ == 0) return out;
  const std::optional<View> before = std::exchange(looked_for_, view_);
  const CoordLimit world = CoordLimit::of(edge_);
  for (std::uint8_t level = 1; level <= tile_levels(*view_); ++level) {
    const bool is_listed = before && before->radius_h == view_->radius_h &&
                           level <= tile_levels(*before) &&
                           tile_at(before->centre, level) == tile_at(view_->centre, level);
    if (is_listed) continue;
    for_each_tile(*view_, world, level, [&](const ChunkKey& key) {
      if (!tiles_.contains(key) && !is_below_empty(key)) out.push_back(key);
    });
  }
  return out;
}

FarTiles::Missing FarTiles::missing() const {
  Missing out;
  if (!view_ || tile_levels(*view_) == 0) return out;
  const CoordLimit world = CoordLimit::of(edge_);
  for_each_tile(*view_, world, tile_levels(*view_), [&](const ChunkKey& root) {
    if (!tiles_.contains(root)) ++out.roots;
  });
  for (const auto& [key, tile] : tiles_) {
    if (key.lod <= 1 || is_empty(*tile.voxels)) continue;
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
