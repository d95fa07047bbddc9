#include "server/world/ground/tile_sending.hpp"

#include <algorithm>
#include <utility>

#include "common/core/tile_keys.hpp"

namespace runstone {

std::size_t tile_price(const std::vector<MadeTile>& made) {
  std::size_t price = 0;
  for (const MadeTile& one : made) {
    if (one.is_past) {
      price += one.key.lod == 1 ? kTileChildren : 1;
    } else if (!one.is_known && !one.tile->voxels.is_uniform()) {
      price += one.key.lod == 1 ? 2 : 1;
    }
  }
  return price;
}

void TileSending::save(const std::vector<MadeTile>& made) {
  std::vector<std::pair<ChunkKey, ChunkPtr>> tiles;
  for (const MadeTile& one : made) {
    if (!one.is_worth_storing() || one.tile->voxels.is_uniform()) continue;
    if (one.rules != base_.order.tile_rules()) continue;
    if (base_.environment.newest_tile_edit(one.key) > one.through) continue;
    // The store refuses it. It is saved when it is made once more.
    if (one.tile->version.seq > base_.order.durable()) continue;
    tiles.emplace_back(one.key, one.tile);
  }
  if (!tiles.empty() && !base_.order.is_stopping() && !base_.order.is_disk_full())
    base_.environment.save_tiles(std::move(tiles));
}

void TileSending::want_again(Viewer& viewer, const ChunkKey& key) {
  viewer.tiles.interest->want_again(key);
  board_.leave(viewer.id(), {&key, 1});
}

/// Records that the session has a tile.
void TileSending::record_sent(Viewer& viewer, const ChunkKey& key, bool is_empty) {
  TileInterest& tiles = *viewer.tiles.interest;
  if (tiles.status(key) == (is_empty ? TileStatus::sent_empty : TileStatus::sent)) return;
  board_.leave(viewer.id(), tiles.set_sent(key, is_empty));
  board_.add_receiver(key, viewer.id());
}

void TileSending::send_same(Viewer& viewer, const ChunkKey& key, Sequence seq) {
  viewer.chunks.claims.drop(key);
  viewer.chunks.not_modified.push_back({key, seq});
  ++base_.counters.tiles_not_modified;
  record_sent(viewer, key, false);
}

/// Queues a tile. Returns false if the session's queue is full. Then the session wants the tile
/// again.
bool TileSending::queue(Cause cause, Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
                        const Clocks& now) {
  // An older state that still waits to be sent must not arrive after this one.
  std::erase_if(viewer.chunks.uniform, [&key](const UniformChunk& one) { return one.key == key; });
  const auto queue_voxels = [&] {
    const std::uint32_t view = sending_.view_in_force(viewer);
    return cause == Cause::request
               ? base_.environment.send_snapshot(viewer.id(), view, key, tile)
               : base_.environment.send_changed_tile(viewer.id(), view, key, tile);
  };
  const bool is_queued =
      tile->voxels.is_uniform() ? sending_.queue_uniform(viewer, key, *tile, now) : queue_voxels();
  if (is_queued) {
    ++base_.counters.tiles_sent;
    return true;
  }
  ++base_.counters.queue_full;
  viewer.chunks.stalled_us = now.steady_us;
  want_again(viewer, key);  // it does not get the tile until it requests it again
  return false;
}

void TileSending::send(Cause cause, Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
                       const Clocks& now) {
  if (viewer.tiles.interest->status(key) == TileStatus::wanted) return;
  CacheClaims& claims = viewer.chunks.claims;
  if (const CachedChunk* claim = claims.find(key)) {
    const bool is_same = claim->version == tile->version &&
                         claim->digest == claim_digest(tile->digest) && !tile->voxels.is_uniform();
    if (is_same) {
      std::erase_if(viewer.chunks.uniform,
                    [&key](const UniformChunk& one) { return one.key == key; });
      return send_same(viewer, key, tile->version.seq);
    }
    claims.drop(key);
  }
  if (queue(cause, viewer, key, tile, now)) record_sent(viewer, key, is_empty(tile->voxels));
}

void TileSending::send_past(Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
                            const Clocks& now) {
  if (!queue(Cause::request, viewer, key, tile, now)) return;
  board_.leave(viewer.id(), viewer.tiles.interest->set_sent(key, is_empty(tile->voxels)));
}

}  // namespace runstone
