// MadeTile: a tile that a TileSource returned, and what is known about it.
#pragma once
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

struct MadeTile {
  ChunkKey key;
  /// Its version is the greatest version of the chunks below it.
  ChunkPtr tile;
  /// The tile contains every edit below it up to this one.
  Sequence through = 0;
  /// A part of it is not made of chunks: the generator approximated it, or a chunk below it is
  /// damaged and left out.
  bool is_approximate = false;
  /// It was read from the store, or an earlier call made it.
  bool is_from_store = false;

  /// Returns true if the tile should be passed to WorldSink::save_tiles(). A tile that contains some
  /// edits behind `through` may lack others, and its version would not tell.
  bool is_worth_storing() const {
    return !is_approximate && !is_from_store && tile->version.seq <= through;
  }
};

}  // namespace runstone
