#include "server/world/ground/past_tiles.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/tile_keys.hpp"
#include "server/world/ground/tile_requests.hpp"

namespace runstone {
namespace {

/// A move of a session from one moment to another, kLive being the live world.
struct TimeMove {
  static constexpr Sequence kLive = std::numeric_limits<Sequence>::max();
  Sequence from = kLive, to = kLive;
};

/// Makes a tile and the tiles below it wanted again where they differ. Appends them to `left`.
void want_differing(const WorldEnvironment& environment, TileInterest& tiles, const ChunkKey& key,
                    const TimeMove& move, std::vector<ChunkKey>& left) {
  const Sequence newest = environment.newest_tile_edit(key);
  if (newest <= std::min(move.from, move.to)) return;
  const TileStatus status = tiles.status(key);
  // A live tile that the session waits for is compared with its moment when it is made. A past one
  // is of another moment.
  const bool waits_for_past = status == TileStatus::waiting && newest > move.from;
  if (waits_for_past || client_has(status)) {
    tiles.want_again(key);
    left.push_back(key);
  }
  if (key.lod == 1) return;
  for (unsigned i = 0; i < kTileChildren; ++i)
    want_differing(environment, tiles, tile_child(key, i), move, left);
}

/// Requests again all past tiles that the session has: this tile and those below it. Appends them
/// to `left`.
void want_past_again(const WorldEnvironment& environment, TileInterest& tiles, const ChunkKey& key,
                     Sequence at, std::vector<ChunkKey>& left) {
  if (environment.newest_tile_edit(key) <= at) return;
  if (client_has(tiles.status(key))) {
    tiles.want_again(key);
    left.push_back(key);
  }
  if (key.lod == 1) return;
  for (unsigned i = 0; i < kTileChildren; ++i)
    want_past_again(environment, tiles, tile_child(key, i), at, left);
}

/// Returns true if the session still waits for the tile of this request. A tile of which it
/// requested the past state is a past tile as long as it sees that moment.
bool is_needed(const Viewer& viewer, const TileRequest& request) {
  return viewer.sees_past() && viewer.past.view->seq == *request.at &&
         viewer.tiles.interest->status(request.key) == TileStatus::waiting;
}

}  // namespace

/// Ends one turn of a request. Returns the viewer, or null if its session is closed.
Viewer* PastTiles::end_turn(SessionId session, const std::vector<MadeTile>& made,
                            const Clocks& now) {
  RUNSTONE_ASSERT(in_flight_ > 0);
  --in_flight_;
  sending_.save(made);
  Viewer* viewer = base_.find(session);
  if (viewer == nullptr) return nullptr;
  --viewer->tiles.past_in_flight;
  base_.quotas.owe_loads(base_.quotas.load_payer(viewer->session), tile_price(made), now.steady_us);
  return viewer;
}

void PastTiles::begin_turn(Viewer& viewer, TileRequest request) {
  ++in_flight_;
  ++viewer.tiles.past_in_flight;
  base_.environment.make_past_tile(viewer.id(), std::move(request));
}

void PastTiles::move_in_time(Viewer& viewer, const Clocks& now) {
  TilesSeen& tiles = viewer.tiles;
  TimeMove move;
  move.from = tiles.at.value_or(TimeMove::kLive);
  tiles.at = viewer.sees_past() ? std::optional(viewer.past.view->seq) : std::nullopt;
  move.to = tiles.at.value_or(TimeMove::kLive);
  if (!tiles.interest || move.from == move.to) return;
  board_.mark_outdated(now);
  std::vector<ChunkKey> left;
  for (const ChunkKey& root : tiles.interest->roots())
    want_differing(base_.environment, *tiles.interest, root, move, left);
  board_.leave(viewer.id(), left);
}

void PastTiles::want_all_again(Viewer& viewer, const Clocks& now) {
  if (!viewer.tiles.interest) return;
  board_.mark_outdated(now);
  std::vector<ChunkKey> left;
  for (const ChunkKey& root : viewer.tiles.interest->roots())
    want_past_again(base_.environment, *viewer.tiles.interest, root, viewer.past.view->seq, left);
  board_.leave(viewer.id(), left);
}

bool PastTiles::is_past(const Viewer& viewer, const ChunkKey& key) const {
  return viewer.sees_past() && base_.environment.newest_tile_edit(key) > viewer.past.view->seq;
}

bool PastTiles::must_wait(const Viewer& viewer, const Clocks& now) const {
  return viewer.tiles.past_in_flight >= kPastTilesOfSessionMax || in_flight_ >= kPastTilesMax ||
         now.steady_us < viewer.tiles.past_retry_us;
}

void PastTiles::request(Viewer& viewer, const ChunkKey& key, const Clocks& now) {
  viewer.tiles.interest->set_waiting(key);
  TileRequest request = request_of(base_, loads_, board_, key, now);
  request.steps_max = kPastTileSteps;
  request.at = viewer.past.view->seq;
  request.past_made = std::make_shared<std::map<ChunkKey, MadeTile>>();
  begin_turn(viewer, std::move(request));
}

Viewer* PastTiles::made(SessionId session, const TileRequest& request,
                        const std::vector<MadeTile>& made, const Clocks& now) {
  Viewer* const viewer = end_turn(session, made, now);
  if (viewer == nullptr || !is_needed(*viewer, request)) return viewer;
  const bool has_rules = !made.empty() && made.back().rules == base_.order.tile_rules();
  if (!has_rules || viewer->chunks.begins) {
    // The tile of a moment follows the message that begins it, and one of earlier rules is made
    // again.
    if (made.empty()) viewer->tiles.past_retry_us = now.steady_us + kTileRetryUs;
    viewer->tiles.interest->want_again(request.key);
  } else {
    sending_.send_past(*viewer, request.key, made.back().for_clients(), now);
  }
  return viewer;
}

Viewer* PastTiles::stopped(SessionId session, const TileRequest& request,
                           const std::vector<MadeTile>& made, const Clocks& now) {
  Viewer* const viewer = end_turn(session, made, now);
  if (viewer == nullptr || base_.order.is_stopping()) return nullptr;
  if (!is_needed(*viewer, request)) return viewer;
  TileRequest more = request;
  more.steps_max += kPastTileSteps;
  begin_turn(*viewer, std::move(more));
  return nullptr;
}

}  // namespace runstone
