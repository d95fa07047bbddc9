// ChunkTable: `base` or `snapshot`, chunks by key. Every chunk that is read is decoded and
// validated, and its digest is computed again from its runs. An error is Kind::corrupt and names
// table and chunk.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/sql/database.hpp"
#include "server/store/chunk_reader.hpp"
#include "server/store/meta_table.hpp"

namespace runstone {

class ChunkTable {
 public:
  enum class Kind { base, snapshot };
  static StoreResult<ChunkTable> open(sql::Database& database, Kind kind);

  /// Returns the chunk of a row, or nullopt if there is no row or it is newer than edit `last`.
  StoreResult<std::optional<Chunk>> load(const ChunkKey& key, Sequence last,
                                         std::uint16_t chunk_edge, RowCheck check);
  /// Returns all rows without their voxels, ascending by key. Fails (corrupt) if their fold is not
  /// `expected`.
  StoreResult<std::vector<StoredChunk>> rows(const RowFold& expected);
  /// Returns keys as Store::chunk_keys(). `database` is that of the table.
  StoreResult<std::vector<ChunkKey>> keys(sql::Database& database,
                                          const std::optional<ChunkKey>& behind,
                                          std::size_t count) const;
  /// Returns the fold of all rows.
  StoreResult<RowFold> fold();
  /// Inserts or replaces one row in the caller's transaction, and updates the fold. Fails
  /// (bad_request) if
  ///   - the chunk has another edge;
  ///   - its digest is not that of its voxels;
  ///   - its version is older than the stored one, or, in `base`, not newer.
  StoreResult<void> save(const ChunkKey& key, const Chunk& chunk, std::uint16_t chunk_edge,
                         RowFold& fold);
  /// Returns "base" or "snapshot".
  const std::string& name() const { return table_; }
  /// Returns the key in `meta` of this table's fold.
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
  /// Calls `each` for all rows without their voxels, ascending by key. Returns their fold.
  StoreResult<RowFold> read_rows(const std::function<void(const StoredChunk&)>& each);
  Unexpected<StoreError> chunk_failure(StoreError::Kind kind, const ChunkKey& key,
                                       std::string what) const;

  Kind kind_;
  std::string file_, table_, fold_key_;
  sql::Statement load_, rows_, version_, save_;
};

}  // namespace runstone
