// What the world strand and the workers that make tiles exchange.
#pragma once
#include <cstddef>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

/// A tile to be made.
struct TileRequest {
  ChunkKey key;
  /// Every edit up to it that touches a chunk below the tile is in `fresh` or in a snapshot on disk.
  Sequence head = 0;
  /// The chunks below the tile whose newest voxels are only in memory, ascending.
  std::vector<std::pair<ChunkKey, ChunkPtr>> fresh;
};

/// A tile that workers made or read. An empty tile is a uniform chunk of kEmpty.
struct MadeTile {
  ChunkKey key;
  ChunkPtr tile;
  Sequence through = 0;         // it contains every edit below it up to this one
  bool is_approximate = false;  // made without the chunks, or without some of them
  bool is_stored = false;       // read from the folder as it is
};

}  // namespace runstone
