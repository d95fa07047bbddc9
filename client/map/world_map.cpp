#include "client/map/world_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/core/coords.hpp"

namespace runstone {
namespace {

/// The search for the nearest tile compares so many keys in the time of one unit of work.
constexpr std::size_t kKeysPerWork = 8;

}  // namespace

void WorldMap::set_materials(const MaterialTable& table) {
  materials_ = map_materials(table);
  for (const auto& [key, tile] : tiles_) stale_.insert(key);
}

void WorldMap::open(const Replica& replica) {
  if (is_open_) return;
  is_open_ = true;
  edge_ = replica.chunk_edge();
  for (const ChunkKey& key : replica.confirmed_keys()) stale_.insert({key.at.x, key.at.z});
}

void WorldMap::close() {
  is_open_ = false;
  tiles_.clear();
  bytes_ = 0;
  stale_.clear();
  unpainted_.clear();
  dropped_.clear();
}

void WorldMap::take(const ReplicaChanges& changes) {
  if (!is_open_) return;
  for (const ChunkChange& change : changes.chunks) {
    // The mesh of a neighbour can be out of date although no voxel of it changed.
    if (change.whole || change.removed || change.layers.here.any())
      stale_.insert({change.key.at.x, change.key.at.z});
  }
}

bool WorldMap::step(const Replica& replica, double x, double z) {
  if (!is_open_) return false;
  if (replica.chunk_edge() != edge_) {  // another world
    close();
    open(replica);
  }
  const auto distance_moved = std::hypot(x - centre_x_, z - centre_z_);
  if (distance_moved > edge_) {  // others are the nearest ones now
    centre_x_ = x;
    centre_z_ = z;
    stale_.merge(dropped_);
    dropped_.clear();
  }
  bool has_changed = false;
  for (std::size_t work = 0; work < kWorkMax && !stale_.empty(); has_changed = true) {
    work += stale_.size() / kKeysPerWork;
    const MapTileKey key = nearest(stale_);
    stale_.erase(key);
    make(replica, key, work);
  }
  for (std::size_t work = 0; work < kWorkMax && !unpainted_.empty(); has_changed = true) {
    work += unpainted_.size() / kKeysPerWork;
    const MapTileKey key = nearest(unpainted_);
    unpainted_.erase(key);
    paint(key, work);
  }
  return has_changed;
}

void WorldMap::make(const Replica& replica, MapTileKey key, std::size_t& work) {
  const auto& view = replica.view();
  if (!view) return;
  std::vector<ShownPtr> shown;
  std::vector<StackedChunk> chunks;
  for (std::int32_t y = view->centre.y + view->radius_v; y >= view->centre.y - view->radius_v;
       --y) {
    ++work;
    ShownPtr chunk = replica.shown({0, {key.x, y, key.z}});
    if (chunk == nullptr) continue;
    chunks.push_back({chunk.get(), y * edge_});
    shown.push_back(std::move(chunk));
  }
  if (chunks.empty()) return erase(key);
  MapTile tile{find_map_tops(chunks, edge_, materials_, work), nullptr};
  const MapTile* const before = find(key);
  const bool has_border = has_other_border(before, &tile);
  if (before == nullptr && !make_room(key, tile.bytes())) {
    dropped_.insert(key);
    return;
  }
  if (before != nullptr) tile.image = before->image;  // until it is painted
  bytes_ += tile.bytes() - (before == nullptr ? 0 : before->bytes());
  tiles_[key] = std::move(tile);
  unpainted_.insert(key);
  if (has_border) border_changed(key);
}

void WorldMap::paint(MapTileKey key, std::size_t& work) {
  const auto found = tiles_.find(key);
  if (found == tiles_.end()) return;
  MapTile& tile = found->second;
  bytes_ -= tile.bytes();
  tile.image =
      paint_map_tile(tile.tops, find({key.x - 1, key.z}), find({key.x, key.z - 1}), materials_);
  bytes_ += tile.bytes();
  work += tile.tops.surface.size();
}

void WorldMap::erase(MapTileKey key) {
  const auto found = tiles_.find(key);
  if (found == tiles_.end()) return;
  bytes_ -= found->second.bytes();
  tiles_.erase(found);
  unpainted_.erase(key);
  border_changed(key);
}

void WorldMap::border_changed(MapTileKey key) {
  for (const MapTileKey beside : {MapTileKey{key.x + 1, key.z}, MapTileKey{key.x, key.z + 1}}) {
    if (tiles_.contains(beside)) unpainted_.insert(beside);
  }
}

bool WorldMap::make_room(MapTileKey key, std::size_t tile_bytes) {
  // The picture comes later.
  const std::size_t wanted =
      tile_bytes + static_cast<std::size_t>(edge_) * static_cast<std::size_t>(edge_) * 4;
  while (!tiles_.empty() && bytes_ + wanted > kBytesMax) {
    const auto farthest = std::max_element(
        tiles_.begin(), tiles_.end(),
        [this](const auto& a, const auto& b) { return distance(a.first) < distance(b.first); });
    const MapTileKey dropped = farthest->first;
    if (distance(dropped) <= distance(key)) return false;
    erase(dropped);
    dropped_.insert(dropped);
  }
  return true;
}

double WorldMap::distance(MapTileKey key) const {
  const double x = (key.x + 0.5) * edge_ - centre_x_, z = (key.z + 0.5) * edge_ - centre_z_;
  return x * x + z * z;
}

MapTileKey WorldMap::nearest(const std::set<MapTileKey>& keys) const {
  return *std::min_element(keys.begin(), keys.end(), [this](MapTileKey a, MapTileKey b) {
    return distance(a) < distance(b);
  });
}

const MapTile* WorldMap::find(MapTileKey key) const {
  const auto found = tiles_.find(key);
  return found == tiles_.end() ? nullptr : &found->second;
}

std::optional<ColumnTop> WorldMap::top(std::int32_t x, std::int32_t z) const {
  if (edge_ == 0) return std::nullopt;
  const ChunkCoord at = chunk_of(VoxelPos{x, 0, z}, edge_);
  const MapTile* const tile = find({at.x, at.z});
  if (tile == nullptr) return std::nullopt;
  const ColumnTop& top = tile->tops.at(x - at.x * edge_, z - at.z * edge_);
  return top.is_found() ? std::optional(top) : std::nullopt;
}

}  // namespace runstone
