// BackupRows: the rows that a repair takes from an older backup of the same world. The common
// history of the two is the part of the log in which their records are equal. If a server ran the
// backup, its later records are not those of the world. So a row is taken only if it belongs to the
// common history.
// Threads: the one that owns the database.
#pragma once
#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "common/generate/generator.hpp"
#include "common/sql/database.hpp"
#include "server/repair/found_rows.hpp"
#include "server/store/store.hpp"

namespace runstone {

class BackupRows {
 public:
  /// Opens the world in the folder of a backup, and verifies every row of it. The error is one
  /// line. Cost: O(rows of the backup).
  static Result<BackupRows, std::string> open(const std::string& folder);

  const std::string& file() const { return store_->file(); }
  const WorldMeta& meta() const { return store_->meta(); }
  StoreResult<LogEnd> log_head() { return store_->log_head(); }

  // The functions below write in the caller's transaction. fill_log() must be the first call,
  // because it finds the common history. Each returns how many rows it took. `head`: that of the
  // damaged world.

  /// Takes the records behind the head that the log lacks, up to the first record that differs. A
  /// record must have an epoch between those of its neighbours, and none above `epoch`, which is
  /// that of the world.
  StoreResult<std::uint64_t> fill_log(sql::Database& database, const LogEnd& head, Epoch epoch);
  /// Takes the chunks of the base that the world lacks, as they were at its head. It takes none if
  /// the common history does not reach the head.
  StoreResult<std::uint64_t> fill_base(sql::Database& database, const LogEnd& head);
  /// Takes the records that compactions kept.
  StoreResult<std::uint64_t> fill_kept_records(sql::Database& database, const LogEnd& head);
  /// Takes players of the common history.
  StoreResult<std::uint64_t> fill_players(sql::Database& database);
  /// Takes earlier names of players of the common history.
  StoreResult<std::uint64_t> fill_names(sql::Database& database);
  /// Takes claims of names that nobody owns in the world. A name that was released since the backup
  /// has its owner again.
  StoreResult<std::uint64_t> fill_claims(sql::Database& database);
  /// Raises watermarks to those of the backup.
  StoreResult<std::uint64_t> fill_watermarks(sql::Database& database);

 private:
  BackupRows(std::unique_ptr<Store> store, std::unique_ptr<Generator> generator)
      : store_(std::move(store)), generator_(std::move(generator)) {}
  bool is_common(AuthorId author) const { return author <= author_max_; }

  std::unique_ptr<Store> store_;
  std::unique_ptr<Generator> generator_;
  Sequence common_ = 0;      // the last record of the common history
  AuthorId author_max_ = 0;  // the highest author number of the common history
};

}  // namespace runstone
