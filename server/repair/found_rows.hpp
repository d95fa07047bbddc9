// FoundRows: writes the rows that a scan found into the tables of the new world. Of two sound rows
// with one key the one that was found first stays; of two watermarks the higher one. A record of
// the log that was not in a used page is doubtful: remove_misfits() deletes it if it does not fit
// its neighbours.
// Threads: the one that owns the database.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/sql/database.hpp"
#include "server/repair/world_scan.hpp"
#include "server/store/meta_table.hpp"

namespace runstone {

/// The columns of a record whose checksum is wrong. They are not proven, and only shown.
struct UnprovenRecord {
  AuthorId author = 0;
  TimeUs time_us = 0;
  VoxelBox box;
};

class FoundRows {
 public:
  /// The database must outlive the object and have the tables of create_schema(), without rows.
  explicit FoundRows(sql::Database& database) : database_(&database) {}

  /// Inserts a proven row, in the caller's transaction.
  StoreResult<void> add(FoundTable table, const StoredRow& row, RowOrigin origin);
  /// Notes a row whose checksum is wrong.
  void add_damaged(FoundTable table, const StoredRow& row);
  /// Makes the tables of the library, if they are not there, in the caller's transaction.
  StoreResult<void> make_library();

  /// Returns the rows of `meta` that were found. They are not written.
  MetaRows& meta() { return meta_; }
  bool has_library() const { return has_library_; }
  /// Returns the doubtful records of the log, ascending.
  const std::map<Sequence, RowOrigin>& doubtful() const { return doubtful_; }
  const std::map<Sequence, UnprovenRecord>& unproven() const { return unproven_; }
  /// Returns a line for each damaged row.
  const std::vector<std::string>& damage() const { return damage_; }

 private:
  void add_meta(const StoredRow& row, RowOrigin origin);

  sql::Database* database_;
  std::map<FoundTable, sql::Statement> inserts_;
  MetaRows meta_;
  bool has_library_ = false;
  std::map<Sequence, RowOrigin> doubtful_;
  std::map<Sequence, UnprovenRecord> unproven_;
  std::vector<std::string> damage_;
};

}  // namespace runstone
