#include "server/world/tile_sending.hpp"

#include <algorithm>
#include <utility>

#include "common/core/tile_keys.hpp"
#include "server/world/delivery.hpp"

namespace runstone {
namespace {

void add_receiver(WorldState& world, const ChunkKey& key, SessionId session) {
  std::vector<SessionId>& sessions = world.tiles.receivers[key].sessions;
  const auto at = std::ranges::lower_bound(sessions, session);
  if (at == sessions.end() || *at != session) sessions.insert(at, session);
}

/// Records that the session has a tile.
void tile_sent(WorldState& world, SessionId session, const ChunkKey& key, bool is_empty) {
  TileInterest& tiles = *world.find(session)->tiles;
  if (tiles.status(key) == (is_empty ? TileStatus::sent_empty : TileStatus::sent)) return;
  leave_tiles(world, session, tiles.set_sent(key, is_empty));
  add_receiver(world, key, session);
}

}  // namespace

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

void save_tiles(WorldState& world, const std::vector<MadeTile>& made) {
  std::vector<std::pair<ChunkKey, ChunkPtr>> tiles;
  for (const MadeTile& one : made) {
    if (!one.is_worth_storing() || one.tile->voxels.is_uniform()) continue;
    if (world.environment.newest_tile_edit(one.key) > one.through) continue;
    // The store refuses it. It is saved when it is made once more.
    if (one.tile->version.seq > world.durable) continue;
    tiles.emplace_back(one.key, one.tile);
  }
  if (!tiles.empty() && !world.is_stopping && !world.disk_is_full)
    world.environment.save_tiles(std::move(tiles));
}

void leave_tiles(WorldState& world, SessionId session, std::span<const ChunkKey> keys) {
  for (const ChunkKey& key : keys) {
    world.tiles.queue.cancel(key, session);
    if (TileReceivers* receivers = world.tiles.receivers.find(key)) {
      std::erase(receivers->sessions, session);
      if (!receivers->sessions.empty()) continue;
      world.tiles.receivers.erase(key);
      world.tiles.resends.cancel(key);
    }
    if (!world.tiles.queue.is_waited_for(key)) world.tiles.queue.cancel_again(key);
  }
}

void send_same_tile(WorldState& world, SessionId session, const ChunkKey& key, Sequence seq) {
  WorldSession& mine = *world.find(session);
  mine.claims.drop(key);
  mine.not_modified_due.push_back({key, seq});
  ++world.counters.tiles_not_modified;
  tile_sent(world, session, key, false);
}

namespace {

/// Why a tile is sent: the session requested it, or it has it in another state.
enum class SendCause : std::uint8_t { request, change };

/// Queues a tile. Returns false if the session's queue is full. Then the session wants the tile again.
bool queue_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
                SendCause cause, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  // An older state that still waits to be sent must not arrive after this one.
  std::erase_if(mine.uniform, [&key](const UniformChunk& one) { return one.key == key; });
  const auto queue_voxels = [&] {
    const std::uint32_t view = view_in_force(world, session);
    return cause == SendCause::request
               ? world.environment.send_snapshot(session, view, key, tile)
               : world.environment.send_changed_tile(session, view, key, tile);
  };
  const bool is_queued =
      tile->voxels.is_uniform() ? queue_uniform(world, session, key, *tile, now) : queue_voxels();
  if (is_queued) {
    ++world.counters.tiles_sent;
    return true;
  }
  ++world.counters.queue_full;
  mine.stalled_us = now.steady_us;
  mine.tiles->want_again(key);
  leave_tiles(world, session, {&key, 1});  // it does not get the tile until it requests it again
  return false;
}

void send_for(SendCause cause, WorldState& world, SessionId session, const ChunkKey& key,
              const ChunkPtr& tile, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (mine.tiles->status(key) == TileStatus::wanted) return;
  if (const CachedChunk* claim = mine.claims.find(key)) {
    const bool is_same = claim->version == tile->version &&
                         claim->digest == claim_digest(tile->digest) && !tile->voxels.is_uniform();
    if (is_same) {
      std::erase_if(mine.uniform, [&key](const UniformChunk& one) { return one.key == key; });
      return send_same_tile(world, session, key, tile->version.seq);
    }
    mine.claims.drop(key);
  }
  if (queue_tile(world, session, key, tile, cause, now))
    tile_sent(world, session, key, is_empty(tile->voxels));
}

}  // namespace

void send_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
               const Clocks& now) {
  send_for(SendCause::request, world, session, key, tile, now);
}

void send_changed_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const ChunkPtr& tile, const Clocks& now) {
  send_for(SendCause::change, world, session, key, tile, now);
}

void send_past_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
                    const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!queue_tile(world, session, key, tile, SendCause::request, now)) return;
  leave_tiles(world, session, mine.tiles->set_sent(key, is_empty(tile->voxels)));
}

}  // namespace runstone
