// TempPlace: a place for the worlds of one test (server/store/store.hpp), removed with the object.
// It is a folder, or, if RUNSTONE_TEST_POSTGRES has the address of a PostgreSQL database, schemas
// of that database. So a test of the store runs on both. Tests of the files of SQLite use
// TempFolder and have the tag [sqlite]; scripts/check-postgres leaves them out.
#pragma once
#include <unistd.h>

#include <cstdlib>
#include <set>
#include <string>

#include "common/core/assert.hpp"
#include "common/postgres/postgres_database.hpp"
#include "common/sqlite/sqlite_file.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/sql/raw_sql.hpp"

namespace runstone::test {

class TempPlace {
 public:
  TempPlace() {
    const char* url = std::getenv("RUNSTONE_TEST_POSTGRES");
    if (url == nullptr) return;
    url_ = url;
    const std::string& path = folder_.path();
    schema_ = "t_";
    for (const char c : path.substr(path.rfind('-') + 1))
      schema_ += static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    schema_ += "_" + std::to_string(::getpid());
    make(schema_);
  }
  ~TempPlace() {
    for (const std::string& schema : schemas_)
      raw_sql(url_, "DROP SCHEMA \"" + schema + "\" CASCADE");
  }
  TempPlace(const TempPlace&) = delete;
  TempPlace& operator=(const TempPlace&) = delete;

  bool is_postgres() const { return !url_.empty(); }
  /// Returns the place of a world.
  std::string path() const { return is_postgres() ? place_of(schema_) : folder_.path(); }
  /// Returns the place of another world, for a plain name. Returns the database of a world for
  /// raw_sql(), for "world.sqlite" and for "NAME/world.sqlite".
  std::string operator/(const std::string& name) {
    if (!is_postgres()) return folder_ / name;
    std::string world = name.substr(0, name.rfind("world.sqlite"));
    if (world.ends_with('/')) world.pop_back();
    if (world.empty()) return path();
    for (char& c : world) c = c == '/' ? '_' : c;
    const std::string schema = schema_ + "_" + world;
    make(schema);
    return place_of(schema);
  }

 private:
  std::string place_of(const std::string& schema) const {
    const char* join = url_.find('?') == std::string::npos ? "?" : "&";
    return url_ + join + "options=-csearch_path%3D" + schema;
  }
  void make(const std::string& schema) {
    if (!schemas_.insert(schema).second) return;
    const std::string made = raw_sql(url_, "CREATE SCHEMA \"" + schema + "\"");
    RUNSTONE_ASSERT(made.empty());
  }

  TempFolder folder_;
  std::string url_, schema_;
  std::set<std::string> schemas_;
};

/// Opens the database of a world for writing, without a store. `file` is that of
/// TempPlace::operator/().
inline sql::Result<sql::Database> open_database(const std::string& file) {
  if (sql::is_postgres_url(file)) return sql::open_postgres(file, sql::PostgresMode::write);
  return sql::open_sqlite(file, sql::SqliteMode::write);
}

/// Returns the name that the store of a place has in messages (WorldInfo::file()).
inline std::string file_of(const std::string& place) {
  return sql::is_postgres_url(place) ? sql::without_password(place) : place + "/world.sqlite";
}

/// Returns the format of the world of a place. The world may not be open.
inline std::string stored_format(const std::string& place) {
  if (sql::is_postgres_url(place)) return raw_sql(place, "SELECT format FROM runstone_world");
  return raw_sql(place + "/world.sqlite", "PRAGMA user_version");
}

}  // namespace runstone::test
