#include "server/world/ground/tile_requests.hpp"

#include <set>
#include <utility>

#include "common/core/tile_keys.hpp"

namespace runstone {

TileRequest request_of(GroundBase& base, Loads& loads, const TileBoard& board, const ChunkKey& tile,
                       const Clocks& now) {
  const WorldChunks& chunks = base.order.chunks();
  std::vector<ChunkKey> absent;
  TileRequest request{tile, base.order.head(), {}, kTileSteps * (1 + board.queue().stops(tile))};
  // Up to the checkpoint, snapshots contain all edits.
  if (base.environment.newest_tile_edit(tile) <= base.order.checkpoint()) return request;
  const ChunkCoord first = first_chunk(tile);
  const std::set<ChunkKey>& dirty = chunks.dirty();
  for (auto at = dirty.lower_bound({0, first}); at != dirty.end(); ++at) {
    if (at->at.x >> tile.lod != tile.at.x) break;
    if (tile_of(at->at, tile.lod) != tile) continue;
    ChunkPtr chunk = chunks.find(*at);
    if (chunk || chunks.residency(*at) == Residency::quarantined) {
      request.fresh.emplace_back(at->at, std::move(chunk));
    } else {
      request.head = 0;
      if (absent.size() < kTileLoadsMax) absent.push_back(*at);
    }
  }
  for (const ChunkKey& key : absent) loads.request(key, now);
  return request;
}

}  // namespace runstone
