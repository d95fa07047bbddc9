// TileTable: the table `tile`: levels of detail that a server made of its chunks. It is a cache: a
// row that is missing or damaged is made again. Invariant: a tile contains every snapshot below it.
// Tiles and snapshots are compared by their versions; a tile carries the greatest version of the
// chunks below it, and contains all their edits up to that version.
// Threads: the one that owns the store.
#pragma once
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "common/sql/database.hpp"
#include "server/store/chunk_reader.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

class TileTable {
 public:
  static StoreResult<TileTable> open(sql::Database& database);

  /// Returns a tile, verified, or nullopt if there is none, or if row `tile_rules` of `meta` is not
  /// `rules` at the moment of the read. The error (corrupt) names file, table and tile.
  StoreResult<std::optional<Chunk>> load(const ChunkKey& key, std::uint32_t rules,
                                         std::uint16_t chunk_edge, RowCheck check);
  /// Returns keys and versions of all tiles, ascending by key, without the rows that
  /// rows_of_no_tile() reports, or none if `tile_rules` is not `rules`.
  StoreResult<std::vector<std::pair<ChunkKey, Version>>> keys(std::uint32_t rules);
  /// Returns a line for each row whose level is not 1 to kTileLevelMax, or whose place does not fit
  /// a key.
  StoreResult<std::vector<std::string>> rows_of_no_tile();

  /// Inserts or replaces a tile in the caller's transaction. Does nothing if a snapshot below it
  /// that remove_stale() got is newer. Fails (bad_request) if the level is not 1 to kTileLevelMax,
  /// if the tile has another edge, or if its digest is not that of its voxels.
  StoreResult<void> save(const ChunkKey& key, const Chunk& tile, std::uint16_t chunk_edge);
  /// Deletes the tiles above these chunks that are older than the chunk, in the caller's
  /// transaction. Call it whenever snapshots are saved. Cost: one look-up for each tile above.
  StoreResult<void> remove_stale(std::span<const std::pair<ChunkKey, Version>> snapshots);
  /// Deletes all tiles, in the caller's transaction.
  StoreResult<void> clear();

 private:
  struct Statements {
    sql::Statement load, keys, no_tile, save, remove_older, clear;
  };
  TileTable(std::string file, Statements statements)
      : file_(std::move(file)), s_(std::move(statements)) {}
  Unexpected<StoreError> tile_failure(StoreError::Kind kind, const ChunkKey& key,
                                      std::string what) const;

  std::string file_;
  Statements s_;
  /// The newest snapshot below each tile that was saved since the table was opened. A tile that was
  /// made before such a snapshot may be saved after it.
  std::map<ChunkKey, Version> newest_below_;
};

}  // namespace runstone
