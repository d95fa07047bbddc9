// TileRequest and MadeTile: what the world strand sends to the workers that make tiles, and what
// they send back.
#pragma once
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "common/tiles/tile_rules.hpp"

namespace runstone {

/// A tile that workers made or read. An empty tile is a uniform chunk of kEmpty.
struct MadeTile {
  ChunkKey key;
  /// Without a veil, as it is stored. Its version is the greatest version of the chunks below it.
  ChunkPtr tile;
  Sequence through = 0;  // it contains every edit below it up to this one, unless it is a past tile
  /// A part of it is not made of chunks: the generator approximated it, or a chunk below it is
  /// damaged and left out.
  bool is_approximate = false;
  /// It was read from the folder, or an earlier request made it.
  bool is_known = false;
  /// A chunk below it is damaged and left out.
  bool is_damaged = false;
  /// It shows an earlier moment (TileRequest::at), and differs from the present one.
  bool is_past = false;
  /// TileVisibility::rules by which it was made.
  std::uint32_t rules = kTileRules;
  /// The digest of the voxels of `tile`. Chunk::digest of an incomplete tile is zero instead, so
  /// that no client claims it.
  Digest voxel_digest{};
  /// The tile with its veil, as clients get it: `tile` itself if the veil changes nothing. Null
  /// until a client requests the tile.
  ChunkPtr veiled = {};

  /// Returns what clients get. Requires the requested tile of TileSource::make().
  const ChunkPtr& for_clients() const { return veiled ? veiled : tile; }

  /// Returns true if clients may keep it and claim it by its version. A tile that contains some
  /// edits behind `through` may lack others, and its version would not tell.
  bool is_complete() const { return !is_past && !is_damaged && tile->version.seq <= through; }
  /// Returns true if the tile should be stored.
  bool is_worth_storing() const { return !is_approximate && !is_known && is_complete(); }
};

/// A tile to be made.
struct TileRequest {
  ChunkKey key;
  /// Every edit up to it that touches a chunk below the tile is in `fresh` or in a snapshot on
  /// disk.
  Sequence head = 0;
  /// The chunks below the tile whose newest voxels are only in memory, ascending. A chunk that is
  /// null cannot be shown: the tile shows nothing there.
  std::vector<std::pair<ChunkCoord, ChunkPtr>> fresh;
  /// The call stops when it has read or generated so many chunks and tiles, so that others get
  /// their turn.
  std::size_t steps_max = std::numeric_limits<std::size_t>::max();
  /// The tile is made as it was after this edit. Then what is newer in `fresh` is not used.
  std::optional<Sequence> at = std::nullopt;
  /// For a request with `at`: the past tiles that earlier turns made, without those below another
  /// one of them. Used by the worker alone.
  std::shared_ptr<std::map<ChunkKey, MadeTile>> past_made = {};
};

}  // namespace runstone
