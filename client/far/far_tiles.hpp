// FarTiles: the tiles that arrived, by key, always as runs. The mesher of distant ground reads
// them.
//   - A tile is replaced as a whole. The newest answer counts.
//   - An empty tile says that everything below it is empty, so the tiles below it are dropped.
//   - Tiles outside of the view are ignored, and dropped when the view moves. So their number is
//     bounded by the view.
// Tiles have no versions, predictions or commits. Pure. One thread; the tiles that are returned are
// immutable and may be read from any thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/run_chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

using TilePtr = std::shared_ptr<const RunChunk>;

class FarTiles {
 public:
  /// Sets the view and the edge of a tile in voxels of the tile. Drops the tiles outside of the
  /// view, or all if the edge is another one. Cost: O(tiles).
  void set_view(const View& view, std::int32_t edge);
  void clear();

  /// Takes a tile. Returns false and ignores it if the view does not have it or its extent is
  /// wrong. Requires a key of level 1 or more.
  bool receive(const ChunkKey& key, RunChunk tile);
  /// Takes a tile of one material.
  bool receive_uniform(const ChunkKey& key, Material material);

  /// Returns null if the tile is not held.
  TilePtr find(const ChunkKey& key) const;
  struct Missing {
    std::size_t roots = 0;   // tiles of the view's highest level
    std::size_t others = 0;  // tiles whose parent is held and is not empty
  };
  /// Returns the number of tiles that the server is expected to send and that are not held. Cost:
  /// O(tiles of the view * log tiles).
  Missing missing() const;
  std::size_t count() const { return tiles_.size(); }
  /// Returns the number of tiles that are not empty.
  std::size_t solid_count() const { return solid_count_; }
  std::size_t bytes() const { return bytes_; }
  /// Returns the keys of the tiles that arrived, changed or left since the last call, ascending.
  std::vector<ChunkKey> drain_changes();

 private:
  bool keep(const ChunkKey& key, TilePtr tile);
  std::map<ChunkKey, TilePtr>::iterator drop(std::map<ChunkKey, TilePtr>::iterator tile);
  void drop_below(const ChunkKey& key);
  void count(const RunChunk& tile, bool is_added);

  std::optional<View> view_;
  std::int32_t edge_ = 0;
  std::map<ChunkKey, TilePtr> tiles_;
  std::map<Material, TilePtr> uniform_;  // tiles of one material share their runs
  std::set<ChunkKey> changed_;
  std::size_t bytes_ = 0, solid_count_ = 0;
};

}  // namespace runstone
