// Tile sending: sends tiles to sessions, and records who has which.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "server/world/tile_request.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Returns what a tile costs the player for whom it was made, besides its request: a load for each
/// tile that was made, and another one for the eight chunks of a tile of level 1. A chunk that is
/// neither kept nor sent takes a fraction of the time of a load. Uniform tiles are free, as most of
/// them need no chunks. A past tile costs the eight chunks that are made for one of level 1.
std::size_t tile_price(const std::vector<MadeTile>& made);
/// Sends a tile, unless the session wants it again after its queue was full: then a later request
/// sends it.
void send_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
               const Clocks& now);
/// Does the same for a tile that replaces one that the session has.
void send_changed_tile(WorldState& world, SessionId session, const ChunkKey& key,
                       const ChunkPtr& tile, const Clocks& now);
/// Queues "not modified". The session claims only tiles that are not uniform.
void send_same_tile(WorldState& world, SessionId session, const ChunkKey& key, Sequence seq);
/// Sends a tile of the moment that the session sees, which waits for it. Later changes of the present
/// tile are not sent to the session.
void send_past_tile(WorldState& world, SessionId session, const ChunkKey& key, const ChunkPtr& tile,
                    const Clocks& now);
/// Saves those of the tiles that are worth it.
void save_tiles(WorldState& world, const std::vector<MadeTile>& made);
/// Forgets tiles that a session does not wait for and does not have any more.
void leave_tiles(WorldState& world, SessionId session, std::span<const ChunkKey> keys);

}  // namespace runstone
