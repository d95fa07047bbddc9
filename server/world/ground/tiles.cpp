#include "server/world/ground/tiles.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <utility>

#include "common/core/tile_keys.hpp"

namespace runstone {
namespace {

/// So many wanted tiles of a session are looked at if past ones have to wait.
constexpr std::size_t kWantedLookedAtMax = 64;

/// Returns the state of a tile. Its digest is that of the voxels that clients get, because other
/// rules may change the veil alone.
TileState state_of(const MadeTile& made) {
  const bool is_complete = made.is_complete();
  return {made.tile->version, is_complete ? made.for_clients()->digest : made.voxel_digest,
          is_complete};
}

}  // namespace

/// Charges the player for whom a tile was made.
void Tiles::charge(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now) {
  const auto payer = payers_.find(key);
  if (payer == payers_.end()) return;
  base_.quotas.owe_loads(payer->second, tile_price(made), now.steady_us);
  payers_.erase(payer);
}

/// Queues a tile for the sessions that have it in another state. A tile is often made because one
/// more session wants it: then the others have it already.
void Tiles::resend_changed(const ChunkKey& key, const MadeTile& made, const Clocks& now) {
  const TileReceivers* const having = board_.receivers(key);
  if (having == nullptr || having->state == state_of(made)) return;
  const std::vector<SessionId> sessions = having->sessions;
  const Sequence through = having->through;  // of what they have, but for those of `lagging`
  const std::vector<SessionId> lagging = board_.resends().cancel(key);
  std::vector<SessionId> receivers;
  for (const SessionId session : sessions) {
    Viewer* const viewer = base_.find(session);
    if (viewer == nullptr) continue;  // closed in this task
    TileInterest& tiles = *viewer->tiles.interest;
    if (past_.is_past(*viewer, key)) {
      // The state that the session has may lack edits that came before its moment.
      if (through < viewer->past.view->seq || std::ranges::find(lagging, session) != lagging.end())
        sending_.want_again(*viewer, key);
    } else if (tiles.status(key) == TileStatus::sent && !is_empty(made.tile->voxels) &&
               tiles.is_hidden(key) && (key.lod > 1 || !base_.interest.nearest_wanted(session))) {
      tiles.set_behind(key);
      board_.leave(session, {&key, 1});
    } else {
      receivers.push_back(session);
    }
  }
  // Sessions that did not get the state before are served first. The queue was charged for them
  // then.
  const auto waits = [&lagging](SessionId session) {
    return std::ranges::find(lagging, session) != lagging.end();
  };
  const auto waiting = std::ranges::partition(receivers, std::not_fn(waits));
  const std::size_t unpaid = receivers.size() - waiting.size();
  board_.queue().charge_changed(now.steady_us, kTileResendUs * static_cast<TimeUs>(unpaid));
  board_.resends().add(key, made.for_clients(), std::move(receivers), !waiting.empty());
}

void Tiles::resend(const Clocks& now) {
  if (board_.resends().empty()) return;
  board_.mark_outdated(now);
  while (const auto next = board_.resends().next(now.steady_us)) {
    const TileReceivers* const having = board_.receivers(next->key);
    if (having == nullptr || !std::ranges::binary_search(having->sessions, next->session)) continue;
    Viewer* const viewer = base_.find(next->session);
    if (viewer == nullptr) continue;  // closed in this task
    if (past_.is_past(*viewer, next->key)) {
      sending_.want_again(*viewer, next->key);
    } else {
      sending_.send_changed(*viewer, next->key, next->tile, now);
    }
  }
}

void Tiles::limit_levels(const Session& session, View& view) const {
  view.levels = session.has(kFeatureTiles) ? std::min(view.levels, base_.config.tile_levels_max)
                                           : std::uint8_t{0};
}

bool Tiles::accepts_claim(const Viewer& viewer, const ChunkKey& key) const {
  if (!viewer.session.has(kFeatureTiles) || key.lod > base_.config.tile_levels_max) return false;
  const std::optional<TileInterest>& tiles = viewer.tiles.interest;
  return !tiles || !client_has(tiles->status(key));
}

std::size_t Tiles::set_view(Viewer& viewer, const View& view, std::span<const View> skipped) {
  std::optional<TileInterest>& tiles = viewer.tiles.interest;
  if (!tiles) {
    if (tile_levels(view) == 0) return 0;
    tiles.emplace(CoordLimit::of(base_.config.chunk_edge));
  }
  const TileInterest::Moved moved = tiles->set_view(view, skipped);
  board_.leave(viewer.id(), moved.left);
  return moved.steps;
}

void Tiles::follow_rules(const Clocks& now) {
  if (std::exchange(rules_, base_.order.tile_rules()) == base_.order.tile_rules()) return;
  board_.make_all_again(now);
  for (Viewer* const viewer : base_.open()) {
    if (!viewer->sees_past()) continue;
    past_.want_all_again(*viewer, now);
    base_.deliveries.insert(viewer->id());
  }
}

void Tiles::request(Viewer& viewer, const Clocks& now) {
  if (!viewer.tiles.interest || base_.order.is_stopping() || chunk_sending_.is_stalled(viewer, now))
    return;
  if (viewer.chunks.begins) return;  // the tiles of a moment follow the message that begins it
  follow_rules(now);
  board_.mark_outdated(now);
  TileInterest& tiles = *viewer.tiles.interest;
  std::size_t claims_left = kTileClaimsPerCall;
  while (tiles.waiting_count() < kTilesWaitingMax) {
    const bool waits = viewer.sees_past() && past_.must_wait(viewer, now);
    const auto key = tiles.next_wanted(kWantedLookedAtMax, [&](const ChunkKey& wanted) {
      return !waits || !past_.is_past(viewer, wanted);
    });
    if (!key) break;
    if (const CachedChunk* claim = viewer.chunks.claims.find(*key)) {
      if (claims_left-- == 0) {
        base_.deliveries.insert(viewer.id());  // the others have a task of their own
        break;
      }
      // A copy that other rules may have made is compared with the tile.
      if (viewer.session.tile_rules == rules_ && base_.environment.is_tile_current(*claim)) {
        tiles.set_waiting(*key);
        sending_.send_same(viewer, *key, claim->version.seq);
        continue;
      }
    }
    if (!base_.quotas.pay_load(viewer.session, now)) break;
    if (past_.is_past(viewer, *key)) {
      past_.request(viewer, *key, now);
      continue;
    }
    tiles.set_waiting(*key);
    board_.queue().want(*key, viewer.id());
  }
  start(now);
}

void Tiles::start(const Clocks& now) {
  if (base_.order.is_stopping()) return;
  follow_rules(now);
  board_.mark_outdated(now);
  while (const auto key = board_.queue().next(now.steady_us, kTilesInFlightMax)) {
    // A session may leave before its tile is made. Its player pays nevertheless.
    if (const auto waits = board_.queue().first_waiting(*key)) {
      const Viewer& viewer = base_.viewers.at(*waits);
      payers_.insert_or_assign(*key, base_.quotas.load_payer(viewer.session));
    }
    base_.environment.make_tile(request_of(base_, loads_, board_, *key, now));
  }
}

void Tiles::made(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now) {
  board_.mark_outdated(now);
  if (made.empty()) {
    payers_.erase(key);
    board_.queue().failed(key, now.steady_us + kTileRetryUs);
    return board_.drop_if_unused(key);
  }
  // The tile is outdated if materials got shapes while it was made.
  if (made.back().rules != base_.order.tile_rules()) return stopped(key, made, now);
  const std::vector<SessionId> waiting = board_.queue().finished(key);
  const MadeTile& tile = made.back();
  charge(key, made, now);
  resend_changed(key, tile, now);
  for (const SessionId session : waiting) {
    Viewer* const viewer = base_.find(session);
    if (viewer == nullptr) continue;  // closed in this task
    if (!past_.is_past(*viewer, key)) {
      sending_.send_requested(*viewer, key, tile.for_clients(), now);
    } else if (viewer->tiles.interest->status(key) == TileStatus::waiting) {
      // An edit came after the session's request. It needs the tile as it was.
      sending_.want_again(*viewer, key);
    }
  }
  if (TileReceivers* having = board_.receivers(key)) {
    having->made_us = now.steady_us;
    having->state = state_of(tile);
    having->through = tile.through;
    if (base_.environment.newest_tile_edit(key) > tile.through)
      board_.queue().make_again(key, now.steady_us + kTileRetryUs);
  }
  sending_.save(made);
  // One session in this task, the others in tasks of their own: each may claim many tiles.
  if (!waiting.empty()) {
    if (Viewer* const first = base_.find(waiting.front())) request(*first, now);
  }
  for (std::size_t i = 1; i < waiting.size(); ++i) base_.deliveries.insert(waiting[i]);
  start(now);
}

void Tiles::stopped(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now) {
  board_.mark_outdated(now);
  charge(key, made, now);
  board_.queue().stopped(key, now.steady_us);
  board_.drop_if_unused(key);
  sending_.save(made);
  start(now);
}

void Tiles::past_made(SessionId session, const TileRequest& request_,
                      const std::vector<MadeTile>& made, const Clocks& now) {
  if (Viewer* const viewer = past_.made(session, request_, made, now)) request(*viewer, now);
}

void Tiles::past_stopped(SessionId session, const TileRequest& request_,
                         const std::vector<MadeTile>& made, const Clocks& now) {
  if (Viewer* const viewer = past_.stopped(session, request_, made, now)) request(*viewer, now);
}

void Tiles::forget(Viewer& viewer) {
  if (viewer.tiles.interest) board_.leave(viewer.id(), viewer.tiles.interest->clear());
}

}  // namespace runstone
