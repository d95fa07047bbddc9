#include "server/world/tile_handlers.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/tile_keys.hpp"
#include "server/world/delivery.hpp"
#include "server/world/past_tiles.hpp"
#include "server/world/quotas.hpp"
#include "server/world/stale_tiles.hpp"
#include "server/world/tile_sending.hpp"

namespace runstone {
namespace {

/// So many wanted tiles of a session are looked at if past ones have to wait.
constexpr std::size_t kWantedLookedAtMax = 64;

/// Charges the player for whom a tile is made.
void charge(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
            const Clocks& now) {
  const auto payer = world.tiles.payers.find(key);
  if (payer != world.tiles.payers.end())
    world.load_ledger.owe(payer->second, tile_price(made), now.steady_us);
}

TileState state_of(const MadeTile& made) {
  return {made.tile->version, made.voxel_digest, made.is_complete()};
}

/// Queues a tile for the sessions that have it in another state. A tile is often made because one more
/// session wants it: then the others have it already.
void resend_changed(WorldState& world, const ChunkKey& key, const MadeTile& made,
                    const Clocks& now) {
  const TileReceivers* const having = world.tiles.receivers.find(key);
  if (having == nullptr || having->state == state_of(made)) return;
  const std::vector<SessionId> sessions = having->sessions;
  const Sequence through = having->through;  // of what they have, but for those of `lagging`
  const std::vector<SessionId> lagging = world.tiles.resends.cancel(key);
  std::vector<SessionId> receivers;
  for (const SessionId session : sessions) {
    WorldSession& mine = *world.find(session);
    const TileStatus status = mine.tiles->status(key);
    if (is_past_tile(world, mine, key)) {
      // The state that the session has may lack edits that came before its moment.
      if (through < mine.history->seq || std::ranges::find(lagging, session) != lagging.end()) {
        mine.tiles->want_again(key);
        leave_tiles(world, session, {&key, 1});
      }
    } else if (status == TileStatus::sent && !is_empty(made.tile->voxels) &&
               mine.tiles->is_hidden(key) &&
               (key.lod > 1 || !world.interest.nearest_wanted(session))) {
      mine.tiles->set_behind(key);
      leave_tiles(world, session, {&key, 1});
    } else {
      receivers.push_back(session);
    }
  }
  // Those who did not get the state before come first, and were paid for then.
  const auto waits = [&lagging](SessionId session) {
    return std::ranges::find(lagging, session) != lagging.end();
  };
  const auto waiting = std::ranges::partition(receivers, std::not_fn(waits));
  const std::size_t unpaid = receivers.size() - waiting.size();
  world.tiles.queue.charge_changed(now.steady_us, kTileResendUs * static_cast<TimeUs>(unpaid));
  world.tiles.resends.add(key, made.for_clients(), std::move(receivers), !waiting.empty());
}

}  // namespace

void resend_tiles(WorldState& world, const Clocks& now) {
  if (world.tiles.resends.empty()) return;
  make_tiles_stale(world, now);
  while (const auto next = world.tiles.resends.next(now.steady_us)) {
    const TileReceivers* const having = world.tiles.receivers.find(next->key);
    if (having == nullptr || !std::ranges::binary_search(having->sessions, next->session)) continue;
    WorldSession& mine = *world.find(next->session);
    if (is_past_tile(world, mine, next->key)) {
      mine.tiles->want_again(next->key);
      leave_tiles(world, next->session, {&next->key, 1});
    } else {
      send_changed_tile(world, next->session, next->key, next->tile, now);
    }
  }
}

void limit_levels(const WorldState& world, const WorldSession& session, View& view) {
  const bool has_tiles = (session.features & kFeatureTiles) != 0;
  view.levels = has_tiles ? std::min(view.levels, world.config.tile_levels_max) : std::uint8_t{0};
}

bool accepts_claim(const WorldState& world, const WorldSession& session, const ChunkKey& key) {
  if ((session.features & kFeatureTiles) == 0 || key.lod > world.config.tile_levels_max)
    return false;
  return !session.tiles || !client_has(session.tiles->status(key));
}

std::size_t set_tile_view(WorldState& world, SessionId session, const View& view,
                          std::span<const View> skipped) {
  WorldSession& mine = *world.find(session);
  if (!mine.tiles) {
    if (tile_levels(view) == 0) return 0;
    mine.tiles.emplace(CoordLimit::of(world.config.chunk_edge));
  }
  const TileInterest::Moved moved = mine.tiles->set_view(view, skipped);
  leave_tiles(world, session, moved.left);
  return moved.steps;
}

void request_tiles(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (!mine.tiles || world.is_stopping || is_stalled(world, mine, now)) return;
  if (mine.begins_due) return;  // the tiles of a moment follow the message that begins it
  make_tiles_stale(world, now);
  std::size_t claims_left = kTileClaimsPerCall;
  while (mine.tiles->waiting_count() < kTilesWaitingMax) {
    const bool waits = mine.history && waits_for_past_tiles(world, mine, now);
    const auto key = mine.tiles->next_wanted(kWantedLookedAtMax, [&](const ChunkKey& wanted) {
      return !waits || !is_past_tile(world, mine, wanted);
    });
    if (!key) break;
    if (const CachedChunk* claim = mine.claims.find(*key)) {
      if (claims_left-- == 0) {
        world.deliveries.insert(session);  // the others have a task of their own
        break;
      }
      if (world.environment.is_tile_current(*claim)) {
        mine.tiles->set_waiting(*key);
        send_same_tile(world, session, *key, claim->version.seq);
        continue;
      }
    }
    if (!pay_load(world, mine, now)) break;
    if (is_past_tile(world, mine, *key)) {
      request_past_tile(world, session, *key, now);
      continue;
    }
    mine.tiles->set_waiting(*key);
    world.tiles.queue.want(*key, session);
  }
  start_tiles(world, now);
}

TileRequest request_of(WorldState& world, const ChunkKey& tile, const Clocks& now) {
  const WorldChunks& chunks = world.authority.chunks();
  std::vector<ChunkKey> absent;
  TileRequest request{
      tile, world.authority.head(), {}, kTileSteps * (1 + world.tiles.queue.stops(tile))};
  // Up to the checkpoint, snapshots contain all edits.
  if (world.environment.newest_tile_edit(tile) <= world.checkpointer.checkpoint()) return request;
  const ChunkCoord first = first_chunk(tile);
  const std::set<ChunkKey>& dirty = chunks.dirty();
  for (auto at = dirty.lower_bound({0, first}); at != dirty.end(); ++at) {
    if (at->at.x >> tile.lod != tile.at.x) break;
    if (tile_of(at->at, tile.lod) != tile) continue;
    ChunkPtr chunk = chunks.find(*at);
    if (chunk || chunks.residency(*at) == Residency::quarantined) {
      request.fresh.emplace_back(at->at, std::move(chunk));
    } else {
      request.head = 0;
      if (absent.size() < kTileLoadsMax) absent.push_back(*at);
    }
  }
  for (const ChunkKey& key : absent) request_load(world, key, now);
  return request;
}

void start_tiles(WorldState& world, const Clocks& now) {
  if (world.is_stopping) return;
  make_tiles_stale(world, now);
  while (const auto key = world.tiles.queue.next(now.steady_us, kTilesInFlightMax)) {
    // A session may leave before its tile is made. Its player pays all the same.
    if (const auto waits = world.tiles.queue.first_waiting(*key))
      world.tiles.payers.insert_or_assign(*key, load_payer(world, *world.find(*waits)));
    world.environment.make_tile(request_of(world, *key, now));
  }
}

void on_tiles_made(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
                   const Clocks& now) {
  make_tiles_stale(world, now);
  if (made.empty()) {
    world.tiles.payers.erase(key);
    world.tiles.queue.failed(key, now.steady_us + kTileRetryUs);
    if (!world.tiles.queue.is_waited_for(key) && !world.tiles.receivers.contains(key))
      world.tiles.queue.cancel_again(key);
    return;
  }
  const std::vector<SessionId> waiting = world.tiles.queue.finished(key);
  const MadeTile& tile = made.back();
  charge(world, key, made, now);
  world.tiles.payers.erase(key);
  resend_changed(world, key, tile, now);
  for (const SessionId session : waiting) {
    WorldSession& mine = *world.find(session);
    if (!is_past_tile(world, mine, key)) {
      send_tile(world, session, key, tile.for_clients(), now);
    } else if (mine.tiles->status(key) == TileStatus::waiting) {
      // An edit came after the session's request. It needs the tile as it was.
      mine.tiles->want_again(key);
      leave_tiles(world, session, {&key, 1});
    }
  }
  if (TileReceivers* found = world.tiles.receivers.find(key)) {
    found->made_us = now.steady_us;
    found->state = state_of(tile);
    found->through = tile.through;
    if (world.environment.newest_tile_edit(key) > tile.through)
      world.tiles.queue.make_again(key, now.steady_us + kTileRetryUs);
  }
  save_tiles(world, made);
  // One session in this task, the others in tasks of their own: each may claim many tiles.
  if (!waiting.empty()) request_tiles(world, waiting.front(), now);
  for (std::size_t i = 1; i < waiting.size(); ++i) world.deliveries.insert(waiting[i]);
  start_tiles(world, now);
}

void on_tile_stopped(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
                     const Clocks& now) {
  make_tiles_stale(world, now);
  charge(world, key, made, now);
  world.tiles.payers.erase(key);
  world.tiles.queue.stopped(key, now.steady_us);
  if (!world.tiles.queue.is_waited_for(key) && !world.tiles.receivers.contains(key))
    world.tiles.queue.cancel_again(key);
  save_tiles(world, made);
  start_tiles(world, now);
}

void forget_tiles(WorldState& world, SessionId session, WorldSession& mine) {
  if (mine.tiles) leave_tiles(world, session, mine.tiles->clear());
}

}  // namespace runstone
