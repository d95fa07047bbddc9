// PastTiles: a session that sees the past gets the tiles of that moment. A tile below which nothing
// was edited since is the same at both times, so the session gets the present tile.
// Workers make the others, from the chunks as they were and from tiles that did not change. Such a
// tile is sent to one session, which is no receiver of its changes. It is neither kept nor stored,
// and has the digest 0, so that no client keeps it either. When the session moves in time or
// returns to the live world, the tiles that differ are sent again.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <vector>

#include "server/world/ground/loads.hpp"
#include "server/world/ground/tile_sending.hpp"

namespace runstone {

/// After this time a tile is tried again that could not be made, or that lacks edits of chunks that
/// are not in memory.
inline constexpr TimeUs kTileRetryUs = 1'000'000;
/// Past tiles with the workers at a time, for a session and for all together. A session that moves
/// in time leaves some behind; they count until they are answered.
inline constexpr std::size_t kPastTilesOfSessionMax = 4, kPastTilesMax = 16;
/// A request of a past tile stops after so many steps (TileRequest::steps_max), and n + 1 times as
/// many in the turn after the n-th. It goes on behind the others. A step makes a chunk as it was,
/// or reads a tile.
inline constexpr std::size_t kPastTileSteps = 64;

class PastTiles {
 public:
  PastTiles(GroundBase& base, Loads& loads, TileBoard& board, TileSending& sending)
      : base_(base), loads_(loads), board_(board), sending_(sending) {}

  /// Makes the tiles wanted again that differ between the moment that the session saw before and
  /// the one that it sees now (PastSeen::view). Call it when the session moved in time. Cost: a
  /// look-up for each tile of the view's highest level, and for the children of each tile that
  /// differs.
  void move_in_time(Viewer& viewer, const Clocks& now);
  /// Requests again all past tiles that the session has. Requires that the session sees the past.
  /// Call it when the rules of tiles have changed. Cost: a look-up for each tile of the view's
  /// highest level, and for the children of each past tile.
  void want_all_again(Viewer& viewer, const Clocks& now);
  /// Returns true if the session sees the past and the tile of that moment differs from the present
  /// one. Requires TileBoard::mark_outdated().
  bool is_past(const Viewer& viewer, const ChunkKey& key) const;
  /// Returns true if no past tile may be requested for the session at the moment. It is tried again
  /// on the next tick.
  bool must_wait(const Viewer& viewer, const Clocks& now) const;
  /// Gives a wanted tile to the workers, as it was. Requires is_past() and not must_wait().
  void request(Viewer& viewer, const ChunkKey& key, const Clocks& now);
  /// Handles the answer to WorldEnvironment::make_past_tile(): the tile, as the last one of `made`.
  /// If `made` is empty, the tile could not be made. It is tried again after kTileRetryUs. Returns
  /// the viewer, which may request its next tiles, or null if it has left.
  Viewer* made(SessionId session, const TileRequest& request, const std::vector<MadeTile>& made,
               const Clocks& now);
  /// Goes on with a request that has stopped, unless the session does not need it any more. Charges
  /// the player for what was made. Returns the viewer if it may request its next tiles, otherwise
  /// null.
  Viewer* stopped(SessionId session, const TileRequest& request, const std::vector<MadeTile>& made,
                  const Clocks& now);

 private:
  Viewer* end_turn(SessionId session, const std::vector<MadeTile>& made, const Clocks& now);
  void begin_turn(Viewer& viewer, TileRequest request);

  GroundBase& base_;
  Loads& loads_;
  TileBoard& board_;
  TileSending& sending_;
  std::size_t in_flight_ = 0;  // past tiles with workers
};

}  // namespace runstone
