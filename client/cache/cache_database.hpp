// CacheDatabase: the database of the chunk cache. The first failure is final: after it, every call
// fails and does nothing. A caller may therefore write a whole batch and call ok() once.
// Threads: one.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "common/sql/database.hpp"

namespace runstone {

class CacheDatabase {
 public:
  /// Opens the file, or makes it. Call ok() afterwards.
  explicit CacheDatabase(const std::string& file);

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

 private:
  void fail(const sql::Error& error) {
    if (ok()) failure_ = error;
  }
  std::optional<sql::Database> database_;  // nullopt if the file cannot be opened
  std::optional<sql::Error> failure_;
};

}  // namespace runstone
