#include "common/sqlite/sql_error.hpp"

#include <sqlite3.h>

#include <utility>

namespace runstone::sql {
namespace {

Error::Kind kind_of_code(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return Error::Kind::full;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return Error::Kind::corrupt;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return Error::Kind::locked;
    case SQLITE_CONSTRAINT:
      return Error::Kind::constraint;
    case SQLITE_ERROR:
      return Error::Kind::bad_statement;
    default:
      return Error::Kind::io;
  }
}

}  // namespace

Unexpected<Error> failure(sqlite3* handle, int code) {
  if (handle == nullptr) return {Error{Error::Kind::io, "", "out of memory"}};
  const char* name = sqlite3_db_filename(handle, "main");
  std::string what = sqlite3_errmsg(handle);
  if (const int system = sqlite3_system_errno(handle);
      system != 0 && (code & 0xff) != SQLITE_CONSTRAINT) {
    what += " (system error " + std::to_string(system) + ")";
  }
  return {Error{kind_of_code(code), name == nullptr ? "" : name, std::move(what)}};
}

}  // namespace runstone::sql
