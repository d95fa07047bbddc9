// ChunkReader: reading of base chunks and snapshots. A base chunk holds an import, or the edits
// that a compaction took out of the log. A snapshot holds a chunk as some edit of the log left it,
// so that a start of the server reads little of the log. A tile is a level of detail, made of the
// chunks below it.
#pragma once
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/ids.hpp"
#include "common/runs/chunk.hpp"
#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// A chunk in the base or in a keyframe, without its voxels.
struct StoredChunk {
  ChunkKey key;
  Version version;  // of the edit that left it so
  Digest digest;
  bool is_base = false;  // true: a base chunk; false: a chunk of a keyframe
  friend bool operator==(const StoredChunk&, const StoredChunk&) = default;
};

/// The checks that a read makes before it returns a chunk or a tile.
enum class RowCheck {
  voxels,  // the checksum of the row, and that its digest is that of its voxels
  bytes    // the checksum: it finds damage, but not a chunk that was written with a wrong digest
};

class ChunkReader : public virtual WorldInfo {
 public:
  /// Sets what later reads check. At first it is RowCheck::voxels. The digest takes about half the
  /// time of a read. Use RowCheck::bytes only to show chunks.
  virtual void set_row_check(RowCheck check) = 0;

  /// Returns true if there are base chunks: imported, or completed by a compaction.
  virtual StoreResult<bool> has_base() = 0;
  /// Returns a base chunk, or nullopt if there is none.
  virtual StoreResult<std::optional<Chunk>> load_base(const ChunkKey& key) = 0;
  /// Returns all base chunks, ascending by key. Fails (corrupt) if a row is missing, or if its key
  /// or version changed.
  virtual StoreResult<std::vector<StoredChunk>> base_chunks() = 0;

  /// Returns the snapshot of a chunk, or nullopt if there is none or it is newer than edit `last`. A
  /// newer one is not read.
  virtual StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key, Sequence last) = 0;
  /// Returns the snapshot of a chunk, or nullopt if there is none.
  StoreResult<std::optional<Chunk>> load_snapshot(const ChunkKey& key) {
    return load_snapshot(key, kSequenceMax);
  }
  /// Returns keys and versions of all snapshots, ascending by key. Fails as base_chunks().
  virtual StoreResult<std::vector<std::pair<ChunkKey, Version>>> snapshot_keys() = 0;
  /// Returns the checkpoint: every edit up to it is contained in a snapshot of each chunk that it
  /// touched. It is 0 if there is none.
  virtual StoreResult<Sequence> checkpoint() = 0;

  /// Returns a stored tile, or nullopt if there is none, if the stored tiles were made by other
  /// rules, or if the world is of format 3 and open for reading only. Fails (corrupt) if the row is
  /// damaged; the tile can be made again.
  virtual StoreResult<std::optional<Chunk>> load_tile(const ChunkKey& key, std::uint32_t rules) = 0;
  /// Returns keys and versions of all stored tiles, ascending by key, or none if they were made by
  /// other rules.
  virtual StoreResult<std::vector<std::pair<ChunkKey, Version>>> tile_keys(std::uint32_t rules) = 0;
  /// Returns a line for each row of tiles whose key is damaged: no tile has such a key, so no other
  /// function reads the row.
  virtual StoreResult<std::vector<std::string>> rows_of_no_tile() = 0;
};

}  // namespace runstone
