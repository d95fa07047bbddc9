// KeyframeTable: the tables `keyframe` and `keyframe_chunk`.
//   - A row of `keyframe_chunk` holds a chunk as one edit left it. It is valid without its
//     keyframe.
//   - A keyframe covers every chunk that was edited up to its sequence. The state of such a chunk
//     at the keyframe is the newest row up to it, or else the base chunk that a compaction
//     completed. The keyframe holds the number of these chunks and the digest over them, as a
//     proof.
// Rows may therefore be written in several transactions before their keyframe. Rows of a keyframe
// that was never finished are harmless. Threads: the one that owns the store.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/keyframe.hpp"

namespace runstone {

class KeyframeTable {
 public:
  static StoreResult<KeyframeTable> open(sql::Database& database);

  /// Returns all keyframes, ascending. Each row is verified.
  StoreResult<std::vector<Keyframe>> all();
  /// Returns all rows up to a sequence, without their voxels, by sequence and key.
  StoreResult<std::vector<StoredChunk>> rows(Sequence last);
  /// Returns the row of a chunk at exactly this sequence, verified, or nullopt if there is none.
  StoreResult<std::optional<Chunk>> load(const ChunkKey& key, Sequence seq,
                                         std::uint16_t chunk_edge, RowCheck check);
  /// Returns the newest row of a chunk up to a sequence, verified, or nullopt if there is none.
  /// Cost: O(log rows).
  StoreResult<std::optional<Chunk>> newest(const ChunkKey& key, Sequence last,
                                           std::uint16_t chunk_edge, RowCheck check);

  /// Inserts a row in the caller's transaction. A row that exists already stays. Fails (corrupt) if
  /// it differs.
  StoreResult<void> save(const ChunkKey& key, const Chunk& chunk, std::uint16_t chunk_edge);
  /// Inserts a keyframe in the caller's transaction.
  StoreResult<void> save(const Keyframe& keyframe);
  /// Deletes all rows and keyframes up to a sequence, in the caller's transaction. Returns the
  /// number of keyframes.
  StoreResult<std::uint64_t> remove(Sequence last);

  /// Checks the proof of each keyframe against the chunks of the base (`start`) and `rows`.
  /// Requires that keyframes and rows ascend by sequence. Fails (corrupt) and names the first
  /// keyframe whose proof is wrong.
  StoreResult<void> prove(const std::vector<Keyframe>& keyframes,
                          const std::vector<StoredChunk>& start,
                          const std::vector<StoredChunk>& rows) const;

 private:
  struct Statements {
    sql::Statement all, rows, load, newest, save_chunk, save, count, remove_chunks, remove;
  };
  KeyframeTable(std::string file, Statements statements)
      : file_(std::move(file)), s_(std::move(statements)) {}
  StoreResult<std::optional<Chunk>> read(sql::Statement& row, const ChunkKey& key, Sequence seq,
                                         std::uint16_t chunk_edge, RowCheck check);
  Unexpected<StoreError> corrupt(std::string where, std::string what) const;

  std::string file_;
  Statements s_;
};

/// Returns the newest state of each chunk in `start` and `rows`, ascending by key. The arguments
/// are those of KeyframeTable::prove().
std::vector<StoredChunk> newest_of(std::vector<StoredChunk> start,
                                   const std::vector<StoredChunk>& rows);

}  // namespace runstone
