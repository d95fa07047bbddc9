// Opens SQLite files as sql::Database. This folder is the only one that calls the SQLite C API.
// SQLite's own mutex is off.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/sql/database.hpp"

namespace runstone::sql {

enum class SqliteMode {
  read,
  write,
  create,  // opens the file for writing, and makes it if it does not exist
  header   // reads the main file alone, without locks and without its WAL
};

/// Opens a file. `vfs` is the name of an SQLite VFS; an empty name means the default one.
Result<Database> open_sqlite(const std::string& file, SqliteMode mode, const std::string& vfs = "");

/// Returns true if a VFS has a file of this name. `vfs` as for open_sqlite().
Result<bool> file_exists(const std::string& file, const std::string& vfs);

// The functions below require a database that open_sqlite() has returned.

/// If `keep` is true, closing the last connection leaves the WAL as it is. Otherwise closing
/// writes the WAL into the main file and deletes it.
void keep_wal_on_close(Database& database, bool keep);
/// Checks the structure of the database. Returns "ok", or the first fault. Fails (io) if a page cannot
/// be read, which SQLite reports as a fault.
Result<std::string> check_structure(Database& database);
using SqliteHeader = std::array<std::uint8_t, 100>;
/// Returns the first 100 bytes of the main file as they are on disk, or nullopt if it is shorter.
/// Fails (io) if they cannot be read.
Result<std::optional<SqliteHeader>> file_header(Database& database);

}  // namespace runstone::sql
