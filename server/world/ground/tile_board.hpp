// TileBoard: the tiles that workers are to make, and which sessions have which tile. Edits make the
// tiles above the touched chunks outdated.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "server/interest/chunk_hash_map.hpp"
#include "server/limits/budget_ledger.hpp"
#include "server/world/environment/tile_request.hpp"
#include "server/world/ground/ground_base.hpp"
#include "server/world/ground/tile_queue.hpp"
#include "server/world/ground/tile_resends.hpp"

namespace runstone {

/// The tiles of level L are made again at most once in 2^(L - 1) of these times.
inline constexpr TimeUs kTileRemakeUs = 1'000'000;

/// A state of a tile. Two tiles with equal states have the same voxels and the same version.
struct TileState {
  Version version;
  Digest digest;             // of the voxels that clients get
  bool is_complete = false;  // MadeTile::is_complete()
  friend bool operator==(const TileState&, const TileState&) = default;
};

/// The sessions that have a tile.
struct TileReceivers {
  std::vector<SessionId> sessions;  // ascending
  std::optional<TimeUs> made_us;    // when it was made last
  /// The state in which it was made last, and MadeTile::through of that. All of them have it, or
  /// one that they claimed, or get it from TileResends. A session that sees the past may have an
  /// earlier one.
  std::optional<TileState> state;
  Sequence through = 0;
};

class TileBoard {
 public:
  explicit TileBoard(GroundBase& base) : base_(base) {}

  TileQueue& queue() { return queue_; }
  const TileQueue& queue() const { return queue_; }
  TileResends& resends() { return resends_; }
  const TileResends& resends() const { return resends_; }
  /// Returns the sessions that have a tile, or null if none has it.
  TileReceivers* receivers(const ChunkKey& key) { return receivers_.find(key); }
  void add_receiver(const ChunkKey& key, SessionId session);
  /// Forgets tiles that a session does not wait for and does not have any more.
  void leave(SessionId session, std::span<const ChunkKey> keys);
  /// Forgets a request of a tile that nobody waits for and nobody has.
  void drop_if_unused(const ChunkKey& key);

  /// Reports that a commit touched these chunks of level of detail 0, ascending, which have their
  /// new versions. The tiles above them become outdated with mark_outdated(), on a tick at the
  /// latest. So edits of one chunk between two calls of it cost as much as one.
  void edited(std::span<const ChunkKey> chunks, const Clocks& now);
  /// Makes the tiles outdated above the chunks that were edited since the last call. Every function
  /// that reads the state of tiles, or the newest edit below one, must call it first. Cost:
  /// O(edited chunks * levels).
  void mark_outdated(const Clocks& now);
  /// Makes all tiles outdated that sessions have. Cost: O(tiles).
  void make_all_again(const Clocks& now);

 private:
  void make_again(const ChunkKey& key, const TileReceivers& receivers, const Clocks& now);

  GroundBase& base_;
  TileQueue queue_;
  TileResends resends_;
  ChunkHashMap<TileReceivers> receivers_;  // no entry is without sessions for long
  // Chunks that commits touched since mark_outdated(). They may repeat.
  std::vector<ChunkKey> edited_;
};

}  // namespace runstone
