// TileResends: changed tiles on their way to the sessions that have them. They are sent one session
// after another at a steady pace: if a crowd got a tile at once, its edits would wait behind
// hundreds of tiles.
// Thread: the world strand.
#pragma once
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

/// The time between two sends. So all sessions together get at most 5,000 changed tiles a second.
inline constexpr TimeUs kTileResendUs = 200;
/// Call resend_tiles() after this time while tiles wait. That many sends are made at once at most.
inline constexpr TimeUs kTileResendBurstUs = 5'000;

class TileResends {
 public:
  struct Send {
    SessionId session = 0;
    ChunkKey key;
    ChunkPtr tile;
  };
  /// Adds a tile for some sessions, the next one last. `is_first`: before the other tiles. Requires
  /// that the tile does not wait in another state.
  void add(const ChunkKey& key, ChunkPtr tile, std::vector<SessionId> sessions,
           bool is_first = false);
  /// Removes a tile. Returns the sessions that did not get it.
  std::vector<SessionId> cancel(const ChunkKey& key);
  bool empty() const { return tiles_.empty(); }

  /// Removes and returns the next send, or nullopt if none waits or none is due.
  std::optional<Send> next(TimeUs now_us);

 private:
  struct Waiting {
    ChunkKey key;
    ChunkPtr tile;
    std::vector<SessionId> sessions;  // the last one is the next; never empty
  };
  std::deque<Waiting> tiles_;  // few: TileQueue makes a changed tile when those before are paid
  TimeUs due_us_ = 0;          // of the next send
};

}  // namespace runstone
