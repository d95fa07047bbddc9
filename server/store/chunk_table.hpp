// ChunkTable: `base` or `snapshot`, chunks by key. What is read is decoded, validated and its digest
// recomputed from runs; anything wrong is Kind::corrupt and names table and chunk.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sqlite/database.hpp"
#include "server/store/chunk_reader.hpp"
#include "server/store/meta_table.hpp"

namespace runstone {

class ChunkTable {
 public:
  enum class Kind { base, snapshot };
  static StoreResult<ChunkTable> open(sql::Database& database, Kind kind);

  StoreResult<std::optional<Chunk>> load(const ChunkKey& key, std::uint16_t chunk_edge);
  /// All rows without their voxels, ascending. Fails if their fold is not `expected`.
  StoreResult<std::vector<StoredChunk>> rows(const RowFold& expected);
  /// Inserts or replaces one row in the caller's transaction and moves the fold with it. Refuses
  /// (bad_request) a chunk of another edge, one whose digest is not that of its voxels, a version older than
  /// the stored one, and in `base` also the stored one again.
  StoreResult<void> save(const ChunkKey& key, const Chunk& chunk, std::uint16_t chunk_edge,
                         RowFold& fold);
  /// "base" or "snapshot".
  const std::string& name() const { return table_; }
  /// Meta key of this table's fold.
  const std::string& fold_key() const { return fold_key_; }

 private:
  ChunkTable(std::string file, Kind kind, std::string table, sql::Statement load,
             sql::Statement rows, sql::Statement version, sql::Statement save)
      : kind_(kind),
        file_(std::move(file)),
        table_(std::move(table)),
        fold_key_(table_ + "_fold"),
        load_(std::move(load)),
        rows_(std::move(rows)),
        version_(std::move(version)),
        save_(std::move(save)) {}
  Unexpected<StoreError> failure(StoreError::Kind kind, const ChunkKey& key,
                                 std::string what) const;

  Kind kind_;
  std::string file_, table_, fold_key_;
  sql::Statement load_, rows_, version_, save_;
};

}  // namespace runstone
