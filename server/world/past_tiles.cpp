#include "server/world/past_tiles.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/tile_keys.hpp"
#include "server/world/quotas.hpp"
#include "server/world/stale_tiles.hpp"
#include "server/world/tile_handlers.hpp"
#include "server/world/tile_sending.hpp"

namespace runstone {
namespace {

/// A move of a session from one moment to another, kLive being the live world.
struct TimeMove {
  static constexpr Sequence kLive = std::numeric_limits<Sequence>::max();
  Sequence from = kLive, to = kLive;
};

/// Makes a tile and the tiles below it wanted again where they differ. Appends them to `left`.
void want_differing(const WorldState& world, TileInterest& tiles, const ChunkKey& key,
                    const TimeMove& move, std::vector<ChunkKey>& left) {
  const Sequence newest = world.environment.newest_tile_edit(key);
  if (newest <= std::min(move.from, move.to)) return;
  const TileStatus status = tiles.status(key);
  // A live tile that the session waits for is compared with its moment when it is made. A past one is
  // of another moment.
  const bool waits_for_past = status == TileStatus::waiting && newest > move.from;
  if (waits_for_past || client_has(status)) {
    tiles.want_again(key);
    left.push_back(key);
  }
  if (key.lod == 1) return;
  for (unsigned i = 0; i < kTileChildren; ++i)
    want_differing(world, tiles, tile_child(key, i), move, left);
}

/// Returns true if the session still waits for the tile of this request. A tile of which it requested
/// the past state is a past tile as long as it sees that moment.
bool is_needed(const WorldSession& session, const TileRequest& request) {
  return session.history && session.history->seq == *request.at &&
         session.tiles->status(request.key) == TileStatus::waiting;
}

/// Ends one turn of a request. Returns the session, or null if it is closed.
WorldSession* end_turn(WorldState& world, SessionId session, const std::vector<MadeTile>& made,
                       const Clocks& now) {
  RUNSTONE_ASSERT(world.tiles.past_in_flight > 0);
  --world.tiles.past_in_flight;
  save_tiles(world, made);
  WorldSession* mine = world.find(session);
  if (mine == nullptr) return nullptr;
  --mine->past_tiles_in_flight;
  world.load_ledger.owe(load_payer(world, *mine), tile_price(made), now.steady_us);
  return mine;
}

void begin_turn(WorldState& world, SessionId session, TileRequest request) {
  ++world.tiles.past_in_flight;
  ++world.find(session)->past_tiles_in_flight;
  world.environment.make_past_tile(session, std::move(request));
}

}  // namespace

void move_tiles_in_time(WorldState& world, SessionId session, const Clocks& now) {
  WorldSession& mine = *world.find(session);
  TimeMove move;
  move.from = mine.tiles_at.value_or(TimeMove::kLive);
  mine.tiles_at = mine.history ? std::optional(mine.history->seq) : std::nullopt;
  move.to = mine.tiles_at.value_or(TimeMove::kLive);
  if (!mine.tiles || move.from == move.to) return;
  make_tiles_stale(world, now);
  std::vector<ChunkKey> left;
  for (const ChunkKey& root : mine.tiles->roots())
    want_differing(world, *mine.tiles, root, move, left);
  leave_tiles(world, session, left);
}

bool is_past_tile(const WorldState& world, const WorldSession& session, const ChunkKey& key) {
  return session.history && world.environment.newest_tile_edit(key) > session.history->seq;
}

bool waits_for_past_tiles(const WorldState& world, const WorldSession& session, const Clocks& now) {
  return session.past_tiles_in_flight >= kPastTilesOfSessionMax ||
         world.tiles.past_in_flight >= kPastTilesMax || now.steady_us < session.past_tiles_retry_us;
}

void request_past_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.tiles->set_waiting(key);
  TileRequest request = request_of(world, key, now);
  request.steps_max = kPastTileSteps;
  request.at = mine.history->seq;
  request.past_made = std::make_shared<std::map<ChunkKey, MadeTile>>();
  begin_turn(world, session, std::move(request));
}

void on_past_tile_made(WorldState& world, SessionId session, const TileRequest& request,
                       const std::vector<MadeTile>& made, const Clocks& now) {
  WorldSession* const mine = end_turn(world, session, made, now);
  if (mine == nullptr) return;
  if (is_needed(*mine, request)) {
    if (made.empty() || mine->begins_due) {
      // The tile of a moment follows the message that begins it.
      if (made.empty()) mine->past_tiles_retry_us = now.steady_us + kTileRetryUs;
      mine->tiles->want_again(request.key);
    } else {
      send_past_tile(world, session, request.key, made.back().for_clients(), now);
    }
  }
  request_tiles(world, session, now);
}

void on_past_tile_stopped(WorldState& world, SessionId session, const TileRequest& request,
                          const std::vector<MadeTile>& made, const Clocks& now) {
  WorldSession* const mine = end_turn(world, session, made, now);
  if (mine == nullptr || world.is_stopping) return;
  if (is_needed(*mine, request)) {
    TileRequest more = request;
    more.steps_max += kPastTileSteps;
    begin_turn(world, session, std::move(more));
  } else {
    request_tiles(world, session, now);
  }
}

}  // namespace runstone
