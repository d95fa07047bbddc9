// MetaTable: what the world is (pinned at creation) and the few values that move: epoch, checkpoint, the head
// of the compacted log and the folds of the chunk tables. Belongs to the thread that owns the store.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <variant>

#include "common/sqlite/database.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

using MetaValue = std::variant<std::int64_t, std::string, Bytes>;
using MetaRows = std::map<std::string, MetaValue, std::less<>>;

/// The pinned rows of a world.
MetaRows rows_of(const WorldMeta& meta);
/// The reverse; the error names the first key that is missing or wrong.
Result<WorldMeta, std::string> meta_of(const MetaRows& rows);

/// Count of rows and a sum of one hash per row, over key and version: kept in `meta` for each chunk table, so
/// that a row which vanished or changed its key is noticed although every row that is left is sound.
struct RowFold {
  std::uint64_t count = 0, sum = 0;
  friend bool operator==(const RowFold&, const RowFold&) = default;
};

class MetaTable {
 public:
  static StoreResult<MetaTable> open(sql::Database& database);

  /// All rows, each checksum verified.
  StoreResult<MetaRows> read_all();
  /// In the caller's transaction, as put_fold().
  StoreResult<void> put(const std::string& key, const MetaValue& value);
  /// A counter that every world has.
  StoreResult<std::uint64_t> counter(const std::string& key);
  StoreResult<RowFold> fold(const std::string& key);
  StoreResult<void> put_fold(const std::string& key, const RowFold& fold);
  /// Row `log_head`: version and time of the last edit that compaction took out of the log; zero if none.
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
