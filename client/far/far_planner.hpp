// FarPlanner: decides which tile is meshed next. MeshPool has the threads, FarTiles the tiles.
//   - A tile is meshed with octants if anything below it is held, so that FarCover can show that.
//   - Chunks and tiles below a tile may be held while those between have not arrived. Each one
//     between gets a stand-in (stand_in.hpp), so that FarCover finds no gap.
//   - A tile whose mesh is new waits until the tiles that are held below it have their first
//     meshes. So coarse ground never hides finer ground that was drawn before.
//   - Servers may give enclosed voxels of a tile any opaque material (common/tiles/veil.hpp).
//     Octants and stand-ins are parts of a tile, and their sides show enclosed voxels of it. So
//     tiles are veiled here before they are meshed. Then a picture is the same whether the server
//     veils or not.
//   - The order is: finer levels first, then the nearest to the eye. All levels look equally large
//     on the screen, because their reach grows with their voxels.
//
// Pure. One thread. Cost: O(levels * log n) per change; O(tiles to mesh) when the eye enters
// another chunk. Memory: one entry for each chunk and tile that is held, and bytes().
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "client/far/far_tiles.hpp"
#include "client/far/tile_mesh.hpp"
#include "common/core/coords.hpp"
#include "common/mesh/visibility.hpp"
#include "common/tiles/veil.hpp"

namespace runstone {

class FarPlanner {
 public:
  /// `tiles` must outlive the planner.
  explicit FarPlanner(const FarTiles& tiles) : tiles_(tiles) {}

  /// Sets the visibility and look of materials. Makes all open jobs void and meshes every tile
  /// again. Materials below `known` are as before. Before the first call, tiles are meshed as they
  /// came. Cost: O(tiles + runs), and a veil for each tile with other materials.
  void set_visibility(const VisibilityTable& visibility, Material known = 0);
  /// Takes the keys of FarTiles::drain_changes().
  void take(std::span<const ChunkKey> changes);
  /// Records whether a chunk of level 0 is held.
  void set_chunk(ChunkCoord at, bool is_held);
  void set_eye(ChunkCoord eye);

  /// Returns the next job, or nullopt while there is none. Pass its key and number to finish().
  std::optional<FarMeshJob> next();
  /// Takes the end of a job. Returns true if its mesh should be drawn. Returns false if the tile
  /// has left since, or if the job was made void.
  bool finish(const ChunkKey& key, std::uint64_t number);
  /// Returns the tiles that are not to be drawn any more, of those for which finish() returned
  /// true.
  std::vector<ChunkKey> take_removals();

  /// Return the number of tiles to mesh, and the number of those that do not have to wait.
  std::size_t dirty_count() const { return dirty_; }
  std::size_t ready_count() const { return ready_.size(); }
  std::size_t stand_in_count() const { return stand_ins_; }
  /// Returns the number of jobs so far.
  std::uint64_t jobs() const { return jobs_; }
  /// Returns the bytes of stand-ins, and of tiles that the veil changed.
  std::size_t bytes() const { return bytes_; }

 private:
  using Rank = std::tuple<std::int64_t, ChunkKey>;  // the level is that of the key
  struct Order {
    bool operator()(const Rank& a, const Rank& b) const;
  };
  struct Node {
    std::uint8_t children = 0;  // bit per child that has a node
    bool is_held = false;       // it has arrived, or is a chunk that is held
    bool is_dirty = false;
    bool is_drawn = false;     // finish() returned true and take_removals() has not named it
    bool has_octants = false;  // the newest job has
    TilePtr tile;              // to be meshed: what arrived, with a veil, or a stand-in; or null
    TilePtr arrived;           // as it arrived; null for a stand-in
    std::uint64_t job = 0;     // number of the open job; 0: none
    std::optional<Rank> rank;  // place in ready_
    bool is_stand_in() const { return tile && !is_held; }
  };

  TilePtr with_veil(const TilePtr& tile);
  Node& make(const ChunkKey& key);
  void erase_if_unused(const ChunkKey& key);
  /// Chooses the tile of a node anew. `from_parent` is true if the tile of its parent has changed.
  void refresh(const ChunkKey& key, Node& node, bool from_parent);
  /// Makes the stand-ins below a tile anew.
  void refresh_stand_ins_below(const ChunkKey& key, const Node& node);
  void set_tile(const ChunkKey& key, Node& node, TilePtr tile, TilePtr arrived, bool is_held);
  void mark(const ChunkKey& key, Node& node);
  void place(const ChunkKey& key, Node& node);
  void place_parent(const ChunkKey& key);
  bool is_ready(const ChunkKey& key, const Node& node) const;

  const FarTiles& tiles_;
  std::optional<VisibilityTable> visibility_;
  VeilScratch veil_scratch_;
  ChunkCoord eye_;
  std::map<ChunkKey, Node> nodes_;  // those that are held, and all that are above them
  std::set<Rank, Order> ready_;
  std::set<ChunkKey> removals_;
  std::uint64_t jobs_ = 0;
  std::size_t dirty_ = 0, stand_ins_ = 0, bytes_ = 0;
};

}  // namespace runstone
