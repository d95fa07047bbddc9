// CacheDatabase: a database of a cache on disk (ChunkCache, TextureCache). The first failure is
// final: after it, every call fails and does nothing. A caller may therefore write a whole batch
// and call ok() once.
// Threads: one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/sql/database.hpp"

namespace runstone {

class CacheDatabase {
 public:
  /// The bytes of a row beside its data: the other columns, and its entries in the indexes.
  static constexpr std::uint64_t kRowOverheadBytes = 160;

  /// Opens the file, or makes it, with the tables of `schema`. `layout` is the number of the
  /// schema. A file with another number belongs to another version of this program, and an empty
  /// one replaces it. Call ok() afterwards.
  CacheDatabase(const std::string& file, const char* schema, std::int64_t layout);
  /// Removes the file of a database and those beside it. Requires that none has it open.
  static void remove(const std::string& file);

  bool ok() const { return !failure_.has_value(); }
  /// Returns true if the failure means that the file is damaged, or is no database of this program.
  bool is_corrupt() const;
  /// Returns the message of the failure. Requires !ok().
  const std::string& error() const { return failure_->what; }

  /// Returns an empty statement after a failure; step() and run() never touch it.
  sql::Statement prepare(const char* text);
  /// Moves to the next row. Returns false at the end and after a failure.
  bool step(sql::Statement& statement);
  /// Steps to the end, then resets the statement.
  void run(sql::Statement& statement);
  void run(const char* text);
  /// Returns the first column of the first row, or 0 without a row.
  std::int64_t integer(const char* text);
  /// Returns the number of rows that the last statement changed.
  std::int64_t changes() { return database_->changes(); }
  /// Drops rows until they have at most `bytes_max`, and lowers `bytes`, what all of them have.
  /// `oldest` gives number and bytes of ?1 rows, the rows that were unused for longest first;
  /// `drop` deletes row ?1. Returns the number of dropped rows.
  std::uint64_t evict(sql::Statement& oldest, sql::Statement& drop, std::uint64_t& bytes,
                      std::uint64_t bytes_max);

 private:
  void open(const std::string& file);
  void fail(const sql::Error& error) {
    if (ok()) failure_ = error;
  }
  std::optional<sql::Database> database_;  // nullopt if the file cannot be opened
  std::optional<sql::Error> failure_;
};

}  // namespace runstone
