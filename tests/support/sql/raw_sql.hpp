// raw_sql: changes a world's database without the store, as damage and other programs do. It calls
// SQLite and libpq directly, so that the layer under test has no part in it.
#pragma once
#include <string>

namespace runstone::test {

/// Runs statements on a database that is closed, or shared. `file` is an SQLite file, or the
/// address of a PostgreSQL database. Returns the first column of the last row as text, or "ERROR:
/// ..." if a statement failed. "; SELECT changes()" at the end returns the number of rows that the
/// statement before changed, also with PostgreSQL.
std::string raw_sql(const std::string& file, const std::string& sql, const char* vfs = nullptr);

}  // namespace runstone::test
