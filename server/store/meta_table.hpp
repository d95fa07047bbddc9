// MetaTable: the values that are pinned when a world is created, and the few that change: epoch,
// checkpoint, the highest author number, head and end of the log, the folds of tables, and the
// material table, which compactions extend.
// Threads: the one that owns the store.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

using MetaValue = std::variant<std::int64_t, std::string, Bytes>;
using MetaRows = std::map<std::string, MetaValue, std::less<>>;

/// Returns the pinned rows of a world.
MetaRows rows_of(const WorldMeta& meta);
/// Returns the values in the pinned rows. The error names the first key that is missing or wrong.
Result<WorldMeta, std::string> meta_of(const MetaRows& rows);

/// The number of rows of a table, and the sum of a hash of each row. `meta` holds one for each of
/// the tables base, snapshot, player, player_instance and name_claim. It detects a row that
/// vanished or changed its key, although every remaining row is sound. A change of one row costs
/// O(1).
struct RowFold {
  std::uint64_t count = 0, sum = 0;
  friend bool operator==(const RowFold&, const RowFold&) = default;
};
/// Counts a row with this checksum in the fold of a table whose rows are hashed by their checksums.
inline void add_row(RowFold& fold, std::int64_t checksum) {
  ++fold.count;
  fold.sum += static_cast<std::uint64_t>(checksum);
}
inline void remove_row(RowFold& fold, std::int64_t checksum) {
  --fold.count;
  fold.sum -= static_cast<std::uint64_t>(checksum);
}

class MetaTable {
 public:
  static StoreResult<MetaTable> open(sql::Database& database);

  /// Returns all rows. Each checksum is verified.
  StoreResult<MetaRows> read_all();
  /// Writes a row in the caller's transaction, as do put_fold() and put_log_head().
  StoreResult<void> put(const std::string& key, const MetaValue& value);
  /// Returns a counter. Fails (corrupt) if it is missing.
  StoreResult<std::uint64_t> counter(const std::string& key);
  StoreResult<RowFold> fold(const std::string& key);
  StoreResult<void> put_fold(const std::string& key, const RowFold& fold);
  /// Returns row `log_head`: version and time of the last edit that a compaction removed, all 0 if
  /// there was none.
  StoreResult<LogEnd> log_head();
  StoreResult<void> put_log_head(const LogEnd& head);

 private:
  MetaTable(std::string file, sql::Statement all, sql::Statement one, sql::Statement write)
      : file_(std::move(file)),
        all_(std::move(all)),
        one_(std::move(one)),
        write_(std::move(write)) {}
  StoreResult<MetaValue> read_row(sql::Statement& row, std::string_view key);
  StoreResult<MetaValue> get(const std::string& key);
  Unexpected<StoreError> corrupt(std::string_view key, std::string what) const;

  std::string file_;
  sql::Statement all_, one_, write_;
};

}  // namespace runstone
