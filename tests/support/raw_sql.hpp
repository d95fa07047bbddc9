// raw_sql: changes a world's database without the store, as damage and other programs do. It calls
// SQLite directly, so that the layer under test has no part in it.
#pragma once
#include <sqlite3.h>

#include <string>

namespace runstone::test {

/// Runs statements on a database that is closed, or shared through its WAL. Returns the first
/// column of the last row as text, or "ERROR: ..." if a statement failed.
inline std::string raw_sql(const std::string& file, const std::string& sql,
                           const char* vfs = nullptr) {
  sqlite3* database = nullptr;
  std::string result;
  if (sqlite3_open_v2(file.c_str(), &database, SQLITE_OPEN_READWRITE, vfs) != SQLITE_OK) {
    result = std::string("ERROR: ") + sqlite3_errmsg(database);
  } else {
    const auto keep = [](void* out, int columns, char** values, char**) {
      if (columns > 0 && values[0] != nullptr) *static_cast<std::string*>(out) = values[0];
      return 0;
    };
    if (sqlite3_exec(database, sql.c_str(), keep, &result, nullptr) != SQLITE_OK) {
      result = std::string("ERROR: ") + sqlite3_errmsg(database);
    }
  }
  sqlite3_close(database);
  return result;
}

}  // namespace runstone::test
