// FarTiles: the tiles that arrived, by key, always as runs. The mesher of distant ground reads
// them.
//   - A tile is replaced as a whole. The newest answer counts.
//   - An empty tile says that everything below it is empty, so the tiles below it are dropped.
//   - Tiles outside of the view are ignored, and dropped when the view moves. So their number is
//     bounded by the view.
//   - Tiles stay over a lost connection, and may come from a cache. They are shown at once, and can
//     be claimed, unless they are uniform: those take fewer bytes than their claims.
// Tiles have no predictions or commits. Pure. One thread; the tiles that are returned are immutable
// and may be read from any thread.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

using TilePtr = std::shared_ptr<const RunChunk>;

class FarTiles {
 public:
  /// Sets the view and the edge of a tile in voxels of the tile. Drops the tiles outside of the
  /// view, or all if the edge is another one. Cost: O(tiles).
  void set_view(const View& view, std::int32_t edge);
  void clear();
  /// Begins a new connection. The tiles stay. Those whose version `trusts` accepts can be claimed,
  /// if the server's `rules` of tiles are not 0 and equal those of the last connection. Cost:
  /// O(tiles).
  void reopen(std::uint32_t rules, const std::function<bool(const Version&)>& trusts);

  /// Reports that the server makes tiles by other rules from now on, whose number is not known
  /// before the next reopen(). Until then, tiles that come cannot be kept, and none is taken from a
  /// cache.
  void end_rules() { rules_ = 0; }

  /// Takes a tile. Returns false and ignores it if the view does not have it or its extent is
  /// wrong. Requires a key of level 1 or more.
  bool receive(const ChunkKey& key, Chunk tile);
  /// Takes a tile of one material.
  bool receive_uniform(const ChunkKey& key, Material material);
  /// Takes the answer that the claimed tile is current. Returns false if no tile of this sequence
  /// is held.
  bool receive_not_modified(const ChunkKey& key, Sequence seq);
  /// Takes a tile from a cache. Returns false and ignores it if the view does not have it, if a
  /// tile is held, or if an empty tile above it is held.
  bool adopt(const ChunkKey& key, ChunkPtr tile);

  /// Returns null if the tile is not held.
  TilePtr find(const ChunkKey& key) const;
  /// Calls visit(key, tile) for the tiles that can be claimed, ascending, until it returns false:
  /// those that the server has not answered for on this connection.
  void for_each_claimable(const std::function<bool(const ChunkKey&, const Chunk&)>& visit) const;
  /// Returns at most `count_max` tiles that a cache does not have yet, ascending. The server has
  /// vouched for them on this connection. Cost: O(tiles).
  std::vector<std::pair<ChunkKey, ChunkPtr>> take_for_cache(std::size_t count_max);
  /// Returns true if take_for_cache() has tiles to return. Cost: O(tiles).
  bool has_for_cache() const;
  /// Returns the keys of tiles of the view that a cache may have, ascending: those that are not
  /// held, and not below a held tile that is empty. Levels whose tiles have not changed since the
  /// last call on this connection are left out. It is empty if the server takes no claims of
  /// tiles. Cost: O(tiles of these levels * log tiles).
  std::vector<ChunkKey> take_not_held();

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
  struct Entry {
    TilePtr voxels;
    ChunkPtr source;           // as it arrived last, with the same voxels; null if it is uniform
    bool is_vouched = false;   // the server has answered for it on this connection
    bool can_be_kept = false;  // for claims and the cache
    bool is_cached = false;

    bool is_for_cache() const { return is_vouched && can_be_kept && !is_cached; }
  };
  using Tiles = std::map<ChunkKey, Entry>;

  bool keep(const ChunkKey& key, Entry tile);
  Tiles::iterator drop(Tiles::iterator tile);
  void drop_below(const ChunkKey& key);
  bool is_below_empty(const ChunkKey& key) const;
  void count(const RunChunk& tile, bool is_added);

  std::optional<View> view_;
  std::optional<View> looked_for_;  // the view of the last take_not_held() on this connection
  std::int32_t edge_ = 0;
  std::uint32_t rules_ = 0;
  Tiles tiles_;
  std::map<Material, TilePtr> uniform_;  // tiles of one material share their runs
  std::set<ChunkKey> changed_;
  std::size_t bytes_ = 0, solid_count_ = 0;
};

}  // namespace runstone
