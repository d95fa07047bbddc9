// FarCover: decides which chunks and which parts of tiles are drawn. All places that a view knows
// are drawn by exactly one of them at every time; FarFades draws another one with it for a moment.
//
// The chunks and tiles that are *present* are those whose quads are on the GPU. A tile is drawn as
// a whole or as *octants*, one for each child. The rules are:
//   - A tile or chunk is *shown* if nothing above it is present, or if its parent is present, shown
//     and open.
//   - A tile is *open* if it has octants, or has no quads at all.
//   - A shown tile draws the octants whose children are not present. If no child is present, or the
//     tile is not open, it is drawn whole.
// So a child replaces its octant at once, and the octant comes back at once when the child leaves.
// If there is a gap between a tile and what is present below it, the octant of the tile is drawn,
// and what is below the gap is hidden. FarPlanner fills such gaps.
//
// Pure. One thread. Cost of a change: O(levels * log n), and O(what is below) if that becomes shown
// or hidden.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>

#include "common/core/coords.hpp"

namespace runstone {

/// The drawn parts of a tile: the whole tile, or a set of octants with a bit for each child.
struct TileParts {
  bool is_whole = false;
  std::uint8_t octants = 0;
  friend bool operator==(const TileParts&, const TileParts&) = default;
};

class FarCover {
 public:
  /// Records that a chunk or tile is present. `is_open` is ignored for chunks.
  void put(const ChunkKey& key, bool is_open);
  /// Records that it is not present any more.
  void remove(const ChunkKey& key);

  /// Returns true if the chunk or tile is present and shown.
  bool shows(const ChunkKey& key) const;
  /// Returns what is drawn of a tile.
  TileParts parts(const ChunkKey& key) const;

 private:
  struct Node {
    std::uint8_t children = 0;          // bit per child that has a node
    std::uint8_t present_children = 0;  // bit per child that is present
    bool is_present = false, is_open = false, is_shown = false;
  };
  /// The tiles above a place: none of them is present; or the parent is present, shown and open; or
  /// one of them hides the place.
  enum class Above : std::uint8_t { nothing, open, hiding };

  const Node* find(const ChunkKey& key) const;
  Node& make(const ChunkKey& key);
  void erase_if_unused(const ChunkKey& key);
  Above above(const ChunkKey& key) const;
  void update(const ChunkKey& key, Node& node, Above above);
  static Above below(const Node& node, Above above);

  std::map<ChunkKey, Node> nodes_;  // those that are present, and all that are above them
};

}  // namespace runstone
