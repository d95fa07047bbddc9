// KeyframeTable: `keyframe` and `keyframe_chunk`. A row of the second holds a chunk as one edit left it and is true by
// itself. A keyframe says that, of each chunk edited up to its sequence, the newest row up to it (or the base, completed by a
// compaction) is the chunk as it stood there, and proves it by their number and the digest over them. So rows may be
// written little by little before their keyframe, and what a keyframe that was never finished left behind does no harm.
// Belongs to the thread that owns the store.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sqlite/database.hpp"
#include "server/store/keyframe_reader.hpp"

namespace runstone {

class KeyframeTable {
 public:
  /// Requires a world of format 3 or newer.
  static StoreResult<KeyframeTable> open(sql::Database& database);

  /// Ascending, each row verified.
  StoreResult<std::vector<Keyframe>> all();
  /// All rows up to a sequence, without their voxels, by sequence and key.
  StoreResult<std::vector<StoredChunk>> rows(Sequence last);
  /// Of a chunk, the row at this very sequence, verified; nothing if there is none.
  StoreResult<std::optional<Chunk>> load(const ChunkKey& key, Sequence seq,
                                         std::uint16_t chunk_edge);
  /// Of a chunk, the newest row up to a sequence, verified; nothing if there is none. O(log rows).
  StoreResult<std::optional<Chunk>> newest(const ChunkKey& key, Sequence last,
                                           std::uint16_t chunk_edge);

  /// All three in the caller's transaction. A row that is there already stays; it is damage if it differs.
  StoreResult<void> save(const ChunkKey& key, const Chunk& chunk, std::uint16_t chunk_edge);
  StoreResult<void> save(const Keyframe& keyframe);
  /// Deletes all rows and keyframes up to a sequence.
  StoreResult<void> remove(Sequence last);

  /// Sums up `rows` (ascending by sequence) over `start`, the chunks of the base, and compares each keyframe with what
  /// it proves. Names the first that is wrong.
  StoreResult<void> prove(const std::vector<Keyframe>& keyframes,
                          const std::vector<StoredChunk>& start,
                          const std::vector<StoredChunk>& rows) const;

 private:
  struct Statements {
    sql::Statement all, rows, load, newest, save_chunk, save, remove_chunks, remove;
  };
  KeyframeTable(std::string file, Statements statements)
      : file_(std::move(file)), s_(std::move(statements)) {}
  StoreResult<std::optional<Chunk>> read(sql::Statement& row, const ChunkKey& key, Sequence seq,
                                         std::uint16_t chunk_edge);
  Unexpected<StoreError> corrupt(std::string where, std::string what) const;

  std::string file_;
  Statements s_;
};

/// `start` with the newest row of each chunk in its place; both as KeyframeTable::prove() takes them. Ascending by key.
std::vector<StoredChunk> newest_of(std::vector<StoredChunk> start,
                                   const std::vector<StoredChunk>& rows);

}  // namespace runstone
