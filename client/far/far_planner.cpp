#include "client/far/far_planner.hpp"

#include <utility>

#include "client/far/child_bits.hpp"
#include "client/far/stand_in.hpp"
#include "common/core/chunk_distance.hpp"
#include "common/runs/material_scan.hpp"

namespace runstone {
bool FarPlanner::Order::operator()(const Rank& a, const Rank& b) const {
  const auto& [distance_a, key_a] = a;
  const auto& [distance_b, key_b] = b;
  return std::tie(key_a.lod, distance_a, key_a) < std::tie(key_b.lod, distance_b, key_b);
}

void FarPlanner::set_visibility(const VisibilityTable& visibility, Material known) {
  visibility_ = visibility;
  // From the highest level down, as in take().
  for (auto found = nodes_.rbegin(); found != nodes_.rend(); ++found) {
    auto& [key, node] = *found;
    if (!node.tile) continue;
    if (node.arrived && has_material_from(*node.arrived, known)) {
      set_tile(key, node, with_veil(node.arrived), node.arrived, true);
      refresh_stand_ins_below(key, node);
    }
    node.job = 0;
    mark(key, node);
  }
}

TilePtr FarPlanner::with_veil(const TilePtr& tile) {
  if (!visibility_) return tile;
  auto changed = veiled(*tile, *visibility_, veil_scratch_);
  return changed ? std::make_shared<const RunChunk>(*std::move(changed)) : tile;
}

void FarPlanner::take(std::span<const ChunkKey> changes) {
  // From the highest level down, so that no stand-in is made of a tile that is replaced next.
  for (auto key = changes.rbegin(); key != changes.rend(); ++key) {
    if (tiles_.find(*key)) {
      refresh(*key, make(*key), false);
    } else if (const auto found = nodes_.find(*key); found != nodes_.end()) {
      refresh(*key, found->second, true);
      erase_if_unused(*key);
    }
  }
}

void FarPlanner::set_chunk(ChunkCoord at, bool is_held) {
  const ChunkKey key{0, at};
  if (is_held) {
    make(key).is_held = true;
  } else if (const auto found = nodes_.find(key); found != nodes_.end()) {
    found->second.is_held = false;
    erase_if_unused(key);
  }
}

FarPlanner::Node& FarPlanner::make(const ChunkKey& key) {
  const auto [found, is_new] = nodes_.try_emplace(key);
  if (is_new && key.lod < kTileLevelMax) {
    const ChunkKey up = tile_parent(key);
    Node& parent = make(up);
    const bool is_first = parent.children == 0;
    parent.children = with_bit(parent.children, child_bit(key), true);
    if (is_first) {
      refresh(up, parent, false);
      if (parent.tile && !parent.has_octants) mark(up, parent);
    }
    if (key.lod > 0) refresh(key, found->second, true);
  }
  return found->second;
}

void FarPlanner::erase_if_unused(const ChunkKey& key) {
  const auto found = nodes_.find(key);
  Node& node = found->second;
  if (node.is_held || node.children != 0) return;
  set_tile(key, node, nullptr, nullptr, false);
  nodes_.erase(found);
  if (key.lod == kTileLevelMax) return;
  const ChunkKey up = tile_parent(key);
  Node& parent = nodes_.at(up);
  parent.children = with_bit(parent.children, child_bit(key), false);
  place(up, parent);
  erase_if_unused(up);
}

void FarPlanner::refresh(const ChunkKey& key, Node& node, bool from_parent) {
  TilePtr arrived = tiles_.find(key);
  const bool is_held = arrived != nullptr;
  TilePtr tile;
  if (is_held) {
    tile = arrived == node.arrived ? node.tile : with_veil(arrived);
  } else if (node.children != 0 && key.lod < kTileLevelMax) {
    const auto parent = nodes_.find(tile_parent(key));
    if (parent != nodes_.end() && parent->second.tile) {
      if (node.is_stand_in() && !from_parent) return;
      tile = std::make_shared<const RunChunk>(stand_in(*parent->second.tile, child_index(key)));
    }
  }
  if (tile == node.tile && is_held == node.is_held) return;
  set_tile(key, node, std::move(tile), std::move(arrived), is_held);
  refresh_stand_ins_below(key, node);
}

void FarPlanner::refresh_stand_ins_below(const ChunkKey& key, const Node& node) {
  if (key.lod <= 1) return;
  for (unsigned i = 0; i < kTileChildren; ++i) {
    if (!has_child(node.children, i)) continue;
    const ChunkKey child = tile_child(key, i);
    Node& below = nodes_.at(child);
    if (!below.is_held) refresh(child, below, true);
  }
}

void FarPlanner::set_tile(const ChunkKey& key, Node& node, TilePtr tile, TilePtr arrived,
                          bool is_held) {
  if (key.lod == 0) return;
  const auto bytes_of = [](const Node& of) {
    return of.tile && of.tile != of.arrived ? sizeof(RunChunk) + of.tile->runs.byte_size() : 0;
  };
  bytes_ -= bytes_of(node);
  stand_ins_ -= node.is_stand_in() ? 1 : 0;
  const bool is_changed = node.tile != tile;
  node.tile = std::move(tile);
  node.arrived = std::move(arrived);
  node.is_held = is_held;
  bytes_ += bytes_of(node);
  stand_ins_ += node.is_stand_in() ? 1 : 0;
  if (node.tile) {
    if (is_changed) mark(key, node);
    return;
  }
  node.job = 0;
  node.has_octants = false;
  if (std::exchange(node.is_dirty, false)) --dirty_;
  if (std::exchange(node.is_drawn, false)) removals_.insert(key);
  place(key, node);
  place_parent(key);
}

void FarPlanner::mark(const ChunkKey& key, Node& node) {
  if (!node.is_dirty) ++dirty_;
  node.is_dirty = true;
  place(key, node);
  place_parent(key);
}

bool FarPlanner::is_ready(const ChunkKey& key, const Node& node) const {
  if (!node.is_dirty || node.job != 0) return false;
  if (node.is_drawn || key.lod <= 1) return true;
  for (unsigned i = 0; i < kTileChildren; ++i) {
    if (!has_child(node.children, i)) continue;
    const Node& below = nodes_.at(tile_child(key, i));
    if (below.tile && !below.is_drawn) return false;
  }
  return true;
}

/// Inserts the tile at its place in the order of jobs, or removes it.
void FarPlanner::place(const ChunkKey& key, Node& node) {
  if (node.rank) {
    ready_.erase(*node.rank);
    node.rank.reset();
  }
  if (!is_ready(key, node)) return;
  node.rank = Rank{distance_squared(key.at, tile_at(eye_, key.lod)), key};
  ready_.insert(*node.rank);
}

void FarPlanner::place_parent(const ChunkKey& key) {
  if (key.lod == kTileLevelMax) return;
  const ChunkKey up = tile_parent(key);
  if (const auto parent = nodes_.find(up); parent != nodes_.end()) place(up, parent->second);
}

void FarPlanner::set_eye(ChunkCoord eye) {
  if (eye == eye_) return;
  eye_ = eye;
  for (const Rank& rank : std::exchange(ready_, {})) {
    const ChunkKey& key = std::get<ChunkKey>(rank);
    Node& node = nodes_.at(key);
    node.rank.reset();
    place(key, node);
  }
}

std::optional<FarMeshJob> FarPlanner::next() {
  if (ready_.empty()) return std::nullopt;
  const ChunkKey key = std::get<ChunkKey>(*ready_.begin());
  Node& node = nodes_.at(key);
  ready_.erase(ready_.begin());
  node.rank.reset();
  node.is_dirty = false;
  --dirty_;
  node.job = ++jobs_;
  node.has_octants = node.children != 0;
  return FarMeshJob{key, node.job, node.tile, node.has_octants};
}

bool FarPlanner::finish(const ChunkKey& key, std::uint64_t number) {
  const auto found = nodes_.find(key);
  if (found == nodes_.end() || found->second.job != number) return false;
  Node& node = found->second;
  node.job = 0;
  node.is_drawn = true;
  removals_.erase(key);
  place(key, node);
  place_parent(key);
  return true;
}

std::vector<ChunkKey> FarPlanner::take_removals() {
  std::vector<ChunkKey> out(removals_.begin(), removals_.end());
  removals_.clear();
  return out;
}

}  // namespace runstone
