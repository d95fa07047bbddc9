// TileAnswers: which tiles of a view the server has sent to a headless bot, without their voxels.
// It says when the far view is complete (docs/protocol.md, "Tiles"). One thread.
#pragma once
#include <cstdint>
#include <map>

#include "common/core/coords.hpp"
#include "protocol/codec/view_tiles.hpp"

namespace runstone {

class TileAnswers {
 public:
  /// Forgets all: a new connection gets every tile again.
  void clear() { is_empty_.clear(); }
  /// Forgets the tiles outside of the view. Cost: O(tiles).
  void set_view(const View& view);
  /// A tile of the view arrived. `is_empty`: it shows that nothing is below it.
  void add(const ChunkKey& key, bool is_empty) { is_empty_[key] = is_empty; }

  /// Returns true if every tile arrived that has an answer. A server that makes fewer levels than
  /// the view has sends those only, the highest one first, so the roots are of the highest level
  /// that arrived. Returns false before the first tile. Cost: O(tiles) if it is true.
  bool are_complete(const View& view, CoordLimit world) const;

 private:
  bool is_complete_below(const View& view, CoordLimit world, const ChunkKey& key) const;
  std::map<ChunkKey, bool> is_empty_;  // of the tiles that arrived; ascending levels
};

}  // namespace runstone
