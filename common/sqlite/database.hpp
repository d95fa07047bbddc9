// sql::Database: a connection to one SQLite file. This folder is the only one that calls the SQLite
// C API.
// Threads: one thread at a time owns a Database and all of its statements. SQLite's own mutex is
// off.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/sqlite/sql_error.hpp"
#include "common/sqlite/statement.hpp"

struct sqlite3;

namespace runstone::sql {

class Database {
 public:
  enum class Mode {
    read,
    write,
    create,  // opens the file for writing, and makes it if it does not exist
    header   // reads the main file alone, without locks and without its WAL
  };

  /// Opens a file. `vfs` is the name of an SQLite VFS; an empty name means the default one.
  static Result<Database> open(const std::string& file, Mode mode, const std::string& vfs = "");

  /// Runs one or more statements and discards their rows.
  Result<void> run(const char* sql);
  Result<Statement> prepare(std::string_view sql);
  /// Returns the first column of the first row. Fails if there is no row.
  Result<std::int64_t> integer(std::string_view sql);
  Result<std::string> text(std::string_view sql);
  /// Returns the number of rows that the last INSERT, UPDATE or DELETE changed.
  std::int64_t changes() const;

  /// If `keep` is true, closing the last connection leaves the WAL as it is. Otherwise closing
  /// writes the WAL into the main file and deletes it.
  void keep_wal_on_close(bool keep);

  /// Returns the first 100 bytes of the main file as they are on disk, or nullopt if it is shorter.
  std::optional<std::array<std::uint8_t, 100>> header();
  /// Returns the name of the main file as it was given to open().
  const std::string& file() const { return file_; }

 private:
  friend class OnlineCopy;
  /// Returns the statement at its first row. Fails if there is no row.
  Result<Statement> first_row(std::string_view sql);

  struct Close {
    void operator()(sqlite3* handle) const;
  };
  Database(std::string file, sqlite3* handle) : file_(std::move(file)), handle_(handle) {}
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Returns true if a VFS has a file of this name. `vfs` as for Database::open().
Result<bool> file_exists(const std::string& file, const std::string& vfs);

}  // namespace runstone::sql
