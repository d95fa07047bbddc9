#include "tests/support/sql/raw_sql.hpp"

#include <libpq-fe.h>
#include <sqlite3.h>

namespace runstone::test {
namespace {

std::string raw_postgres(const std::string& url, std::string sql) {
  constexpr std::string_view kChanges = "; SELECT changes()";
  const bool wants_changes = sql.ends_with(kChanges);
  if (wants_changes) sql.resize(sql.size() - kChanges.size());
  PGconn* const database = PQconnectdb(url.c_str());
  // The role of a test may have settings that a world must bear.
  PQclear(PQexec(database,
                 "SET client_min_messages = warning; SET client_encoding = 'UTF8'; "
                 "SET statement_timeout = 0; SET lock_timeout = 0"));
  PQclear(PQexec(database,
                 "SELECT set_config(name, 'off', false) FROM pg_settings WHERE name = "
                 "'default_transaction_read_only' AND source <> 'configuration file'"));
  PGresult* const result = PQexec(database, sql.c_str());
  std::string out;
  const ExecStatusType status = PQresultStatus(result);
  if (status != PGRES_COMMAND_OK && status != PGRES_TUPLES_OK) {
    out = std::string("ERROR: ") + PQerrorMessage(database);
  } else if (wants_changes) {
    out = PQcmdTuples(result);
  } else if (PQntuples(result) > 0) {
    out = PQgetvalue(result, PQntuples(result) - 1, 0);
  }
  PQclear(result);
  PQfinish(database);
  return out;
}

}  // namespace

std::string raw_sql(const std::string& file, const std::string& sql, const char* vfs) {
  if (file.starts_with("postgresql://")) return raw_postgres(file, sql);
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
