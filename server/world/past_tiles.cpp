#include "server/world/past_tiles.hpp"

#include <algorithm>
#include <limits>
#include <ranges>
#include <set>
#include <utility>

#include "common/core/tile_keys.hpp"
#include "server/world/quotas.hpp"
#include "server/world/stale_tiles.hpp"
#include "server/world/tile_handlers.hpp"
#include "server/world/tile_sending.hpp"

namespace runstone {
namespace {

/// Charges the session's player for tiles that were made for it. Returns false if the session is closed
/// or sees another moment by now.
bool charge_past_tile(WorldState& world, SessionId session, HistoryNumber history,
                      const std::vector<MadeTile>& made, const Clocks& now) {
  const WorldSession* mine = world.find(session);
  if (mine == nullptr) return false;
  world.load_ledger.owe(load_payer(world, *mine), tile_price(made), now.steady_us);
  return mine->history && mine->history->number == history;
}

}  // namespace

void move_tiles_in_time(WorldState& world, SessionId session, const Clocks& now) {
  constexpr Sequence kLive = std::numeric_limits<Sequence>::max();
  WorldSession& mine = *world.find(session);
  const Sequence from = mine.tiles_at.value_or(kLive);
  mine.tiles_at = mine.history ? std::optional(mine.history->seq) : std::nullopt;
  const Sequence to = mine.tiles_at.value_or(kLive);
  const std::set<ChunkKey> loading = std::exchange(mine.past_tiles_loading, {});
  if (!mine.tiles || from == to) return;
  make_tiles_stale(world, now);
  const auto differs = [&, earlier = std::min(from, to)](const ChunkKey& key) {
    return world.environment.newest_tile_edit(key) > earlier;
  };
  std::set<ChunkKey> differing;
  std::vector<ChunkKey> left;
  // Parents come before their children. Below a tile that is the same, everything is the same.
  const std::vector<ChunkKey> known = mine.tiles->known();
  for (const ChunkKey& key : known | std::views::reverse) {
    const ChunkKey parent = key.lod < kTileLevelMax ? tile_parent(key) : key;
    const bool has_parent = mine.tiles->status(parent) != TileStatus::unknown && parent != key;
    if ((has_parent && !differing.contains(parent)) || !differs(key)) continue;
    differing.insert(key);
    const TileStatus status = mine.tiles->status(key);
    if (status == TileStatus::wanted || (status == TileStatus::waiting && !loading.contains(key)))
      continue;  // it is sent as it should be then
    mine.tiles->want_again(key);
    left.push_back(key);
  }
  leave_tiles(world, session, left);
}

bool is_past_tile(const WorldState& world, const WorldSession& session, const ChunkKey& key) {
  return session.history && world.environment.newest_tile_edit(key) > session.history->seq;
}

bool waits_for_past_tiles(const WorldSession& session) {
  return session.past_tiles_loading.size() >= kPastTilesLoadingMax;
}

void request_past_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const Clocks& now) {
  WorldSession& mine = *world.find(session);
  mine.tiles->set_waiting(key);
  mine.past_tiles_loading.insert(key);
  TileRequest request = request_of(world, key, now);
  request.at = mine.history->seq;
  world.environment.make_past_tile(session, mine.history->number, std::move(request));
}

void on_past_tile_made(WorldState& world, SessionId session, HistoryNumber history,
                       const TileRequest& request, const std::vector<MadeTile>& made,
                       const Clocks& now) {
  if (!charge_past_tile(world, session, history, made, now)) return;
  WorldSession& mine = *world.find(session);
  mine.past_tiles_loading.erase(request.key);
  if (mine.tiles->status(request.key) == TileStatus::waiting) {
    if (made.empty()) {
      // What it shows stays, as if it were sent again.
      leave_tiles(world, session, mine.tiles->set_sent(request.key, false));
    } else {
      send_tile(world, session, request.key, made.back().tile, now);
    }
  }
  request_tiles(world, session, now);
}

void on_past_tile_stopped(WorldState& world, SessionId session, HistoryNumber history,
                          const TileRequest& request, const std::vector<MadeTile>& made,
                          const Clocks& now) {
  if (!charge_past_tile(world, session, history, made, now)) return;
  TileRequest more = request;
  more.steps_max += kTileSteps;
  world.environment.make_past_tile(session, history, std::move(more));
}

}  // namespace runstone
