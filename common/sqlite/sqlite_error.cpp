#include <sqlite3.h>

#include <cerrno>
#include <utility>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {
namespace {

/// Returns true if an I/O error means that there is no room. SQLite reports a full disk as
/// SQLITE_FULL, with two exceptions: a full quota, and a shared memory of a WAL that cannot grow. A
/// failed fsync is never one of them: the state of the disk is unknown after it.
bool has_no_room(int code, int system) {
  const bool says_full = system == ENOSPC || system == EDQUOT;
  return says_full && (code == SQLITE_IOERR_WRITE || code == SQLITE_IOERR_SHMSIZE);
}

Error::Kind kind_of_code(int code, int system) {
  if (has_no_room(code, system)) return Error::Kind::full;
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

Unexpected<Error> sqlite_failure(sqlite3* handle, int code) {
  if (handle == nullptr) return {Error{Error::Kind::io, "", "out of memory"}};
  const char* name = sqlite3_db_filename(handle, "main");
  std::string what = sqlite3_errmsg(handle);
  const int system = sqlite3_system_errno(handle);
  if (system != 0 && (code & 0xff) != SQLITE_CONSTRAINT) {
    what += " (system error " + std::to_string(system) + ")";
  }
  return {Error{kind_of_code(code, system), name == nullptr ? "" : name, std::move(what)}};
}

}  // namespace runstone::sql
