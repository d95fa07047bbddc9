// TileSending: sends tiles to sessions, and records who has which.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "server/world/ground/chunk_sending.hpp"
#include "server/world/ground/tile_board.hpp"

namespace runstone {

/// Returns what a tile costs the player for whom it was made, besides its request: a load for each
/// tile that was made, and another one for the eight chunks of a tile of level 1. A chunk that is
/// neither kept nor sent takes a fraction of the time of a load. Uniform tiles are free, as most of
/// them need no chunks. A past tile costs the eight chunks that are made for one of level 1.
std::size_t tile_price(const std::vector<MadeTile>& made);

class TileSending {
 public:
  TileSending(GroundBase& base, ChunkSending& sending, TileBoard& board)
      : base_(base), sending_(sending), board_(board) {}

  /// Sends a tile that the session requested, unless the session wants it again after its queue was
  /// full: then a later request sends it.
  void send_requested(Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
                      const Clocks& now) {
    send(Cause::request, viewer, key, tile, now);
  }
  /// Sends a tile that replaces one that the session has, unless the session wants it again.
  void send_changed(Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile, const Clocks& now) {
    send(Cause::change, viewer, key, tile, now);
  }
  /// Queues "not modified". The session claims only tiles that are not uniform.
  void send_same(Viewer& viewer, const ChunkKey& key, Sequence seq);
  /// Sends a tile of the moment that the session sees, which waits for it. Later changes of the
  /// present tile are not sent to the session.
  void send_past(Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile, const Clocks& now);
  /// Makes a tile wanted again, and forgets that the session has it or waits for it.
  void want_again(Viewer& viewer, const ChunkKey& key);
  /// Saves those of the tiles that are worth it.
  void save(const std::vector<MadeTile>& made);

 private:
  /// Why a tile is sent: the session requested it, or it has it in another state.
  enum class Cause : std::uint8_t { request, change };
  void send(Cause cause, Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
            const Clocks& now);
  bool queue(Cause cause, Viewer& viewer, const ChunkKey& key, const ChunkPtr& tile,
             const Clocks& now);
  void record_sent(Viewer& viewer, const ChunkKey& key, bool is_empty);

  GroundBase& base_;
  ChunkSending& sending_;
  TileBoard& board_;
};

}  // namespace runstone
