// Tiles: sessions get the tiles of their views, and get them again after edits. Workers make the
// tiles. Edits make the tiles above the touched chunks outdated, in O(levels) for each chunk; an
// outdated tile that sessions have is made again after a pause that grows with its level, and sent
// to them.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "server/world/ground/past_tiles.hpp"
#include "server/world/ground/tile_requests.hpp"
#include "server/world/ground/tile_sending.hpp"

namespace runstone {

/// Claims of tiles that one call of Tiles::request() answers. Each takes about a microsecond or
/// two.
inline constexpr std::size_t kTileClaimsPerCall = 512;
/// Bytes that count as read for each claim of a tile, since it is answered without a load.
inline constexpr std::size_t kTileClaimBytes = 64;
/// Tiles with the workers at a time.
inline constexpr std::size_t kTilesInFlightMax = 4;

class Tiles {
 public:
  Tiles(GroundBase& base, Loads& loads, ChunkSending& sending)
      : base_(base),
        loads_(loads),
        chunk_sending_(sending),
        board_(base),
        sending_(base, sending, board_),
        past_(base, loads, board_, sending_),
        rules_(base.order.tile_rules()) {}

  /// Reports that a commit touched these chunks (TileBoard::edited()).
  void edited(std::span<const ChunkKey> chunks, const Clocks& now) { board_.edited(chunks, now); }
  /// Limits the levels of a view that the client sent to those that the server makes.
  void limit_levels(const Session& session, View& view) const;
  /// Returns true if the server may use this claim of a tile: the session has tiles of its level,
  /// and waits for this one or may wait for it later.
  bool accepts_claim(const Viewer& viewer, const ChunkKey& key) const;
  /// Moves a session's tiles to its view. `skipped`: as in TileInterest::set_view(). Returns the
  /// cost.
  std::size_t set_view(Viewer& viewer, const View& view, std::span<const View> skipped);
  /// Makes the tiles wanted again that differ after the session moved in time (PastTiles).
  void move_in_time(Viewer& viewer, const Clocks& now) { past_.move_in_time(viewer, now); }
  /// Requests wanted tiles of the session, up to kTilesWaitingMax. A tile of which the session
  /// claims a current copy is answered by "not modified", at most kTileClaimsPerCall of them.
  void request(Viewer& viewer, const Clocks& now);
  /// Gives tiles to the workers. Call it on each tick and after requests.
  void start(const Clocks& now);
  /// Returns true if changed tiles wait to be sent (TileResends).
  bool has_resends() const { return !board_.resends().empty(); }
  /// Sends changed tiles to sessions that have them, as far as their pace allows. Cost:
  /// O(kTileResendBurstUs / kTileResendUs) sends.
  void resend(const Clocks& now);
  /// Forgets the tiles of a session that ends.
  void forget(Viewer& viewer);

  // Answers of the workers.
  /// Sends a tile that workers made, the last one of `made`, to the sessions that wait for it or
  /// have it at an earlier state. A tile of earlier rules is made again instead. Saves the tiles
  /// that are worth saving. `made` is empty if the tile could not be made.
  void made(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now);
  /// Saves tiles that were made on the way to a tile. The tile is requested again when others had
  /// their turn.
  void stopped(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now);
  void past_made(SessionId session, const TileRequest& request, const std::vector<MadeTile>& made,
                 const Clocks& now);
  void past_stopped(SessionId session, const TileRequest& request,
                    const std::vector<MadeTile>& made, const Clocks& now);

 private:
  void charge(const ChunkKey& key, const std::vector<MadeTile>& made, const Clocks& now);
  void resend_changed(const ChunkKey& key, const MadeTile& made, const Clocks& now);
  /// If the rules of tiles have changed, because materials got shapes, makes all tiles outdated
  /// that sessions have.
  void follow_rules(const Clocks& now);

  GroundBase& base_;
  Loads& loads_;
  ChunkSending& chunk_sending_;
  TileBoard board_;
  TileSending sending_;
  PastTiles past_;
  std::uint32_t rules_;               // Order::tile_rules() at the last follow_rules()
  std::map<ChunkKey, Payer> payers_;  // of the tiles that workers make because a session waits
};

}  // namespace runstone
