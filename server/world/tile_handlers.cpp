#include "server/world/tile_handlers.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/tile_keys.hpp"
#include "server/world/delivery.hpp"
#include "server/world/quotas.hpp"

namespace runstone {
namespace {

/// As many edited chunks wait at most until the tiles above them become stale.
constexpr std::size_t kEditedMax = 4'096;

/// Returns what a tile costs the player for whom it was made, besides its request: a load for each
/// tile that was made, and another one for the eight chunks of a tile of level 1. A chunk that is
/// neither kept nor sent takes a fraction of the time of a load. Uniform tiles are free, as most of
/// them need no chunks.
std::size_t price_of(const std::vector<MadeTile>& made) {
  std::size_t price = 0;
  for (const MadeTile& one : made) {
    if (!one.is_known && !one.tile->voxels.is_uniform()) price += one.key.lod == 1 ? 2 : 1;
  }
  return price;
}

/// Charges the player for whom a tile is made.
void charge(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
            const Clocks& now) {
  const auto payer = world.tiles.payers.find(key);
  if (payer != world.tiles.payers.end())
    world.load_ledger.owe(payer->second, price_of(made), now.steady_us);
}

void add_receiver(WorldState& world, const ChunkKey& key, SessionId session) {
  std::vector<SessionId>& sessions = world.tiles.receivers[key].sessions;
  const auto at = std::ranges::lower_bound(sessions, session);
  if (at == sessions.end() || *at != session) sessions.insert(at, session);
}

/// Forgets tiles that a session does not wait for and does not have any more.
void leave_tiles(WorldState& world, SessionId session, std::span<const ChunkKey> keys) {
  for (const ChunkKey& key : keys) {
    world.tiles.queue.cancel(key, session);
    if (TileReceivers* receivers = world.tiles.receivers.find(key)) {
      std::erase(receivers->sessions, session);
      if (!receivers->sessions.empty()) continue;
      world.tiles.receivers.erase(key);
    }
    if (!world.tiles.queue.is_waited_for(key)) world.tiles.queue.cancel_again(key);
  }
}

/// Collects the chunks below a tile that are newer in memory than on disk. An absent one has edits
/// that nobody has applied yet; then `head` is 0. Some of the absent ones are loaded, so that the tile
/// is complete when it is made again.
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

void make_again(WorldState& world, const ChunkKey& key, const TileReceivers& receivers,
                const Clocks& now) {
  const TimeUs pause = kTileRemakeUs << (key.lod - 1);
  const TimeUs due = receivers.made_us ? *receivers.made_us + pause : now.steady_us;
  world.tiles.queue.make_again(key, std::max(now.steady_us + kTileRemakeUs, due));
}

/// Makes the tiles stale above the chunks that were edited since the last call. Every function of this
/// file that looks at tiles calls it first.
void make_stale(WorldState& world, const Clocks& now) {
  std::vector<ChunkKey>& chunks = world.tiles.edited;
  if (chunks.empty()) return;
  std::ranges::sort(chunks);
  chunks.erase(std::ranges::unique(chunks).begin(), chunks.end());
  // Each chunk is recorded with its own newest edit. Neighbours in the list often share theirs.
  const WorldChunks& versions = world.authority.chunks();
  const std::span<const ChunkKey> all = chunks;
  for (std::size_t first = 0, end = 0; first < all.size(); first = end) {
    const Sequence seq = versions.version(all[first]).seq;
    for (end = first + 1; end < all.size() && versions.version(all[end]).seq == seq;) ++end;
    world.environment.tiles_edited(all.subspan(first, end - first), seq);
  }
  std::optional<ChunkKey> before;
  for (const ChunkKey& chunk : chunks) {
    for (std::uint8_t level = 1; level <= world.config.tile_levels_max; ++level) {
      const ChunkKey key = tile_of(chunk.at, level);
      // The chunk before has marked this tile and those above it.
      if (before && tile_of(before->at, level) == key) break;
      if (const TileReceivers* receivers = world.tiles.receivers.find(key))
        make_again(world, key, *receivers, now);
    }
    before = chunk;
  }
  chunks.clear();
}

TileState state_of(const MadeTile& made) {
  return {made.tile->version, made.digest, made.is_complete()};
}

/// Records that the session has a tile.
void tile_sent(WorldState& world, SessionId session, const ChunkKey& key, bool is_empty) {
  TileInterest& tiles = *world.find(session)->tiles;
  if (tiles.status(key) == (is_empty ? TileStatus::sent_empty : TileStatus::sent)) return;
  leave_tiles(world, session, tiles.set_sent(key, is_empty));
  add_receiver(world, key, session);
}

/// Queues "not modified". The session claims only tiles that are not uniform.
void send_same_tile(WorldState& world, SessionId session, const ChunkKey& key, Sequence seq) {
  WorldSession& mine = *world.find(session);
  mine.claims.drop(key);
  mine.not_modified_due.push_back({key, seq});
  ++world.counters.tiles_not_modified;
  tile_sent(world, session, key, false);
}

/// Sends a tile, unless the session wants it again after its queue was full: then a later request
/// sends it.
void send_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
               const Clocks& now) {
  WorldSession& mine = *world.find(session);
  if (mine.tiles->status(key) == TileStatus::wanted) return;
  // An older state that still waits to be sent must not arrive after this one.
  std::erase_if(mine.uniform, [&key](const UniformChunk& one) { return one.key == key; });
  if (const CachedChunk* claim = mine.claims.find(key)) {
    const bool is_same = claim->version == tile->version &&
                         claim->digest == claim_digest(tile->digest) && !tile->voxels.is_uniform();
    if (is_same) return send_same_tile(world, session, key, tile->version.seq);
    mine.claims.drop(key);
  }
  const bool is_sent =
      tile->voxels.is_uniform()
          ? queue_uniform(world, session, key, *tile, now)
          : world.environment.send_snapshot(session, view_in_force(world, session), key, tile);
  if (!is_sent) {
    ++world.counters.queue_full;
    mine.stalled_us = now.steady_us;
    mine.tiles->want_again(key);
    leave_tiles(world, session, {&key, 1});  // it does not get the tile until it requests it again
    return;
  }
  ++world.counters.tiles_sent;
  tile_sent(world, session, key, is_empty(tile->voxels));
}

/// Requests tiles of the session whose turn it is. Answers at most `claims_left` claims, and takes them
/// off.
void request_some(WorldState& world, SessionId session, std::size_t& claims_left,
                  const Clocks& now) {
  if (world.find(session) == nullptr) return;
  WorldSession& mine = *world.find(session);
  if (!mine.tiles || is_stalled(world, mine, now)) return;
  while (mine.tiles->waiting_count() < kTilesWaitingMax) {
    const auto key = mine.tiles->next_wanted();
    if (!key) break;
    if (const CachedChunk* claim = mine.claims.find(*key)) {
      if (claims_left == 0) {
        world.deliveries.insert(session);  // the others have a task of their own
        break;
      }
      --claims_left;
      if (world.environment.is_tile_current(*claim)) {
        mine.tiles->set_waiting(*key);
        send_same_tile(world, session, *key, claim->version.seq);
        continue;
      }
    }
    if (world.tiles.request_tokens.wait_us(1, now.steady_us) != 0) {
      world.tiles.requests.insert(session);
      break;
    }
    if (!pay_load(world, mine, now)) break;
    world.tiles.request_tokens.take(1, now.steady_us);
    mine.tiles->set_waiting(*key);
    world.tiles.queue.want(*key, session);
  }
}

void save_tiles(WorldState& world, const std::vector<MadeTile>& made) {
  std::vector<std::pair<ChunkKey, ChunkPtr>> tiles;
  for (const MadeTile& one : made) {
    if (!one.is_worth_storing() || one.tile->voxels.is_uniform()) continue;
    if (world.environment.newest_tile_edit(one.key) > one.through) continue;
    tiles.emplace_back(one.key, one.tile);
  }
  if (!tiles.empty() && !world.is_stopping && !world.disk_is_full)
    world.environment.save_tiles(std::move(tiles));
}

}  // namespace

void limit_levels(const WorldState& world, const WorldSession& session, View& view) {
  const bool has_tiles = (session.features & kFeatureTiles) != 0;
  view.levels = has_tiles ? std::min(view.levels, world.config.tile_levels_max) : std::uint8_t{0};
}

bool accepts_claim(const WorldState& world, const WorldSession& session, const ChunkKey& key) {
  if ((session.features & kFeatureTiles) == 0 || key.lod > world.config.tile_levels_max)
    return false;
  const TileStatus status = session.tiles ? session.tiles->status(key) : TileStatus::unknown;
  return status != TileStatus::sent && status != TileStatus::sent_empty;
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
  if (world.is_stopping) return;
  if (world.find(session)->tiles) world.tiles.requests.insert(session);
  make_stale(world, now);
  std::size_t claims_left = kTileClaimsPerCall;
  while (claims_left != 0 && world.tiles.request_tokens.wait_us(1, now.steady_us) == 0) {
    const auto next = world.tiles.requests.take_next();
    if (!next) break;
    request_some(world, *next, claims_left, now);
  }
  start_tiles(world, now);
}

void start_tiles(WorldState& world, const Clocks& now) {
  if (world.is_stopping) return;
  make_stale(world, now);
  while (const auto key = world.tiles.queue.next(now.steady_us, kTilesInFlightMax)) {
    // A session may leave before its tile is made. Its player pays all the same.
    if (const auto waits = world.tiles.queue.first_waiting(*key))
      world.tiles.payers.insert_or_assign(*key, load_payer(world, *world.find(*waits)));
    world.environment.make_tile(request_of(world, *key, now));
  }
}

void on_tiles_made(WorldState& world, const ChunkKey& key, const std::vector<MadeTile>& made,
                   const Clocks& now) {
  make_stale(world, now);
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
  const TileState state = state_of(tile);
  std::vector<SessionId> receivers;
  // A tile is often made because one more session wants it: the others have it already.
  const TileReceivers* const having = world.tiles.receivers.find(key);
  if (having != nullptr && having->state != state) receivers = having->sessions;
  world.tiles.queue.charge_changed(now.steady_us,
                                   kTileResendUs * static_cast<TimeUs>(receivers.size()));
  for (const SessionId session : waiting) {
    if (std::ranges::find(receivers, session) == receivers.end()) receivers.push_back(session);
  }
  for (const SessionId session : receivers) send_tile(world, session, key, tile.tile, now);
  if (TileReceivers* found = world.tiles.receivers.find(key)) {
    found->made_us = now.steady_us;
    found->state = state;
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
  make_stale(world, now);
  charge(world, key, made, now);
  world.tiles.payers.erase(key);
  world.tiles.queue.stopped(key, now.steady_us);
  if (!world.tiles.queue.is_waited_for(key) && !world.tiles.receivers.contains(key))
    world.tiles.queue.cancel_again(key);
  save_tiles(world, made);
  start_tiles(world, now);
}

void tiles_edited(WorldState& world, std::span<const ChunkKey> chunks, const Clocks& now) {
  if (world.config.tile_levels_max == 0) return;
  std::vector<ChunkKey>& edited = world.tiles.edited;
  if (chunks.size() == 1 && !edited.empty() && edited.back() == chunks.front()) return;
  edited.insert(edited.end(), chunks.begin(), chunks.end());
  if (edited.size() >= kEditedMax) make_stale(world, now);
}

void forget_tiles(WorldState& world, SessionId session, WorldSession& mine) {
  world.tiles.requests.erase(session);
  if (mine.tiles) leave_tiles(world, session, mine.tiles->clear());
}

}  // namespace runstone
