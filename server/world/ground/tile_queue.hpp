// TileQueue: the tiles that workers are to make, and the sessions that wait for them. The order:
//   1. The tiles for which sessions wait: the coarsest level first, within a level the earliest
//      request.
//   2. The tiles that sessions have and that an edit has changed: the one that has been due for
//      longest first.
// A tile that takes long is made in several turns. Between them it waits behind the others, and
// every second turn is given to such a tile, the one that waits for longest. Bounds: the waited
// ones by kTilesWaitingMax for each session, the changed ones by the tiles that sessions have.
// Thread: the world strand.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "server/interest/chunk_hash_map.hpp"

namespace runstone {

/// Tiles that a session may wait for at a time.
inline constexpr std::size_t kTilesWaitingMax = 32;
/// Changed tiles may use up to this much time that passed without one. It is the time of a tick,
/// because tiles are started once a tick.
inline constexpr TimeUs kChangedBurstUs = 50'000;

class TileQueue {
 public:
  /// Adds a session that waits for a tile. Requires that it does not wait for it yet.
  void want(const ChunkKey& key, SessionId session);
  /// Makes the tile due at this time, unless it is due before.
  void make_again(const ChunkKey& key, TimeUs due_us);
  /// Makes changed tiles owe this time. next() returns none of them until it has passed.
  void charge_changed(TimeUs now_us, TimeUs cost_us) {
    changed_from_us_ = std::max(changed_from_us_, now_us - kChangedBurstUs) + cost_us;
  }
  /// Removes a session that waits for a tile. If nobody waits any more, the tile is not made for
  /// it.
  void cancel(const ChunkKey& key, SessionId session);
  /// Removes a tile that is to be made again, because no session has it any more.
  void cancel_again(const ChunkKey& key);

  /// Removes and returns the next tile. Returns nullopt if none is due or in_flight_max are under
  /// way. A tile that is under way is not returned again before finished().
  std::optional<ChunkKey> next(TimeUs now_us, std::size_t in_flight_max);
  /// Ends a tile that next() returned. Returns the sessions that wait for it, in the order of their
  /// requests. They wait no longer.
  std::vector<SessionId> finished(const ChunkKey& key);
  /// Ends a tile that next() returned and that could not be made. It is due again at this time,
  /// like a changed one; the sessions go on waiting.
  void failed(const ChunkKey& key, TimeUs due_us);

  /// Ends the turn of a tile that next() returned. The sessions go on waiting; if there are none,
  /// it is due at this time.
  void stopped(const ChunkKey& key, TimeUs now_us);
  /// Returns how many turns of the tile have ended with stopped().
  std::size_t stops(const ChunkKey& key) const {
    const auto found = stops_.find(key);
    return found == stops_.end() ? 0 : found->second;
  }

  bool is_waited_for(const ChunkKey& key) const { return waiting_.contains(key); }
  /// Returns the session that has waited for the tile the longest, or nullopt.
  std::optional<SessionId> first_waiting(const ChunkKey& key) const {
    const Waiting* waiting = waiting_.find(key);
    return waiting == nullptr ? std::nullopt : std::optional(waiting->sessions.front());
  }
  std::size_t in_flight() const { return in_flight_.size(); }
  /// Returns the number of tiles that wait to be made.
  std::size_t count() const { return wanted_.size() + due_.size(); }

 private:
  using Place = std::tuple<bool, int, std::uint64_t, ChunkKey>;  // the first: it has stopped
  struct Waiting {
    std::vector<SessionId> sessions;
    std::optional<Place> place;  // in wanted_; nullopt while it is under way or due again
  };

  std::uint64_t requests_ = 0;
  ChunkHashMap<Waiting> waiting_;
  std::set<Place> wanted_;
  std::map<ChunkKey, TimeUs> again_;
  std::set<std::pair<TimeUs, ChunkKey>> due_;  // the tiles of again_
  std::set<ChunkKey> in_flight_;
  std::map<ChunkKey, std::size_t> stops_;  // of tiles that wait or are under way
  bool is_turn_of_stopped_ = false;
  TimeUs changed_from_us_ = 0;
};

}  // namespace runstone
