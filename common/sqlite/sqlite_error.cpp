#include <sqlite3.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {
namespace {

/// Returns the system's error behind an error of SQLite, or 0. sqlite3_system_errno() does not know
/// it if a commit fails, so the WAL and the main file are asked first.
int system_error_of(sqlite3* handle, int code) {
  const int kind = code & 0xff;
  if (kind != SQLITE_IOERR && kind != SQLITE_CORRUPT && kind != SQLITE_CANTOPEN) return 0;
  if (kind != SQLITE_CANTOPEN) {
    for (const int which : {SQLITE_FCNTL_JOURNAL_POINTER, SQLITE_FCNTL_FILE_POINTER}) {
      sqlite3_file* file = nullptr;
      if (sqlite3_file_control(handle, "main", which, &file) != SQLITE_OK) continue;
      if (const int system = last_error_of(file); system != 0) return system;
    }
  }
  return kind == SQLITE_CORRUPT ? 0 : sqlite3_system_errno(handle);
}

/// Returns true if a write found no room and wrote nothing that counts. SQLite itself knows ENOSPC
/// alone. The caller may write again when there is room. A failed fsync is never such an error: the
/// state of the disk is unknown after it.
bool has_no_room(int code, int system) {
  const bool is_refused =
      system == ENOSPC || system == EDQUOT || system == EFBIG || system == EROFS;
  return is_refused && (code == SQLITE_IOERR_WRITE || code == SQLITE_IOERR_SHMSIZE ||
                        code == SQLITE_IOERR_TRUNCATE);
}

/// Returns true if SQLite calls a file damaged because the system could not read it: it reports EIO
/// and ENXIO of a read as damage.
bool is_unreadable(int code, int system) {
  return (code & 0xff) == SQLITE_CORRUPT && (system == EIO || system == ENXIO);
}

/// Returns true if SQLite could not make a file beside a database that is there. It then tries to open
/// that file for reading, so that the reason is lost.
bool cannot_make_file(const char* database, int code, int system) {
  return (code & 0xff) == SQLITE_CANTOPEN && system == ENOENT && database != nullptr &&
         ::access(database, F_OK) == 0;
}

Error::Kind kind_of_code(int code, int system) {
  if (has_no_room(code, system)) return Error::Kind::full;
  if (is_unreadable(code, system)) return Error::Kind::io;
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

int last_error_of(sqlite3_file* file) {
  int system = 0;
  if (file != nullptr && file->pMethods != nullptr)
    file->pMethods->xFileControl(file, SQLITE_FCNTL_LAST_ERRNO, &system);
  return system;
}

std::string with_system_error(std::string what, int system) {
  if (system == 0) return what;
  return std::move(what) + ": " + std::generic_category().message(system) + " (system error " +
         std::to_string(system) + ")";
}

Unexpected<Error> sqlite_failure(sqlite3* handle, int code) {
  if (handle == nullptr) return {Error{Error::Kind::io, "", "out of memory"}};
  const char* name = sqlite3_db_filename(handle, "main");
  std::string what = sqlite3_errmsg(handle);
  const int system = system_error_of(handle, code);
  if (is_unreadable(code, system)) what = "cannot be read";
  if (cannot_make_file(name, code, system)) {
    return {Error{Error::Kind::io, name,
                  "a file beside it, such as its -wal, cannot be made: the disk is full or "
                  "read-only, or the folder cannot be written"}};
  }
  return {Error{kind_of_code(code, system), name == nullptr ? "" : name,
                with_system_error(std::move(what), system)}};
}

}  // namespace runstone::sql
