#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {
namespace {

/// Returns the last error of the WAL or the journal, or else of the main file, or 0.
int last_error_of_files(sqlite3* handle) {
  for (const int which : {SQLITE_FCNTL_JOURNAL_POINTER, SQLITE_FCNTL_FILE_POINTER}) {
    sqlite3_file* file = nullptr;
    if (sqlite3_file_control(handle, "main", which, &file) != SQLITE_OK) continue;
    if (const int system = last_error_of(file); system != 0) return system;
  }
  return 0;
}

/// Returns the system's error behind an error of SQLite, or 0. `last` is errno after the call that
/// failed. If it is no error of a disk, SQLite has looked for another file afterwards. Then the files
/// know the error, unless it was that of a journal that is gone. sqlite3_system_errno() does not know
/// the error if a commit fails.
int system_error_of(sqlite3* handle, int code, int last) {
  switch (code & 0xff) {
    case SQLITE_READONLY:
      return disk_error(last);
    case SQLITE_CANTOPEN:
      return last != 0 ? last : sqlite3_system_errno(handle);
    case SQLITE_CORRUPT:
      return is_of_reading(last) ? last : last_error_of_files(handle);
    case SQLITE_IOERR: {
      if (disk_error(last) != 0) return last;
      const int of_files = last_error_of_files(handle);
      return of_files != 0 ? of_files : sqlite3_system_errno(handle);
    }
    default:
      return 0;
  }
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

/// Returns true if SQLite calls a file damaged because the system could not read it.
bool is_unreadable(int code, int system) {
  return (code & 0xff) == SQLITE_CORRUPT && is_of_reading(system);
}

/// Returns true if SQLite could not make a file that it needs, and the database is there.
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

/// Returns the system's error of making a file beside `file`, or 0 if that is possible.
int error_of_new_file(sqlite3_vfs* vfs, const std::string& file) {
  constexpr int kSystemCallsVersion = 3;
  if (vfs == nullptr || vfs->iVersion < kSystemCallsVersion || vfs->xGetSystemCall == nullptr)
    return 0;
  using Open = int (*)(const char*, int, int);
  const auto open = reinterpret_cast<Open>(vfs->xGetSystemCall(vfs, "open"));
  if (open == nullptr) return 0;
  const std::string probe = file + "-probe";
  ::unlink(probe.c_str());  // of a program that was killed here
  const int descriptor =
      open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return errno;
  ::close(descriptor);
  ::unlink(probe.c_str());
  return 0;
}

}  // namespace

bool is_of_reading(int system) { return system == EIO || system == ENXIO; }

int disk_error(int system) {
  switch (system) {
    case EACCES:
    case EDQUOT:
    case EFBIG:
    case EIO:
    case EMFILE:
    case ENFILE:
    case ENOSPC:
    case ENXIO:
    case EPERM:
    case EROFS:
      return system;
    default:
      return 0;
  }
}

std::string why_not_made(std::string what, sqlite3_vfs* vfs, const std::string& file) {
  const int system = error_of_new_file(vfs, file);
  if (system != 0) return with_system_error(std::move(what), system);
  return std::move(what) + ", but another one can be made there now: try again";
}

std::string why_read_only(int system) {
  const std::string what = "cannot be opened for writing";
  if (disk_error(system) != 0) return with_system_error(what, system);
  return what + ": it or its file system is read-only, or the disk failed";
}

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
  const int last = errno;
  std::string what = sqlite3_errmsg(handle);
  errno = last;
  return sqlite_failure(handle, code, std::move(what));
}

Unexpected<Error> sqlite_failure(sqlite3* handle, int code, std::string what) {
  const int system = system_error_of(handle, code, errno);
  const char* name = sqlite3_db_filename(handle, "main");
  if (is_unreadable(code, system)) what = "cannot be read";
  if (cannot_make_file(name, code, system)) {
    sqlite3_vfs* vfs = nullptr;
    sqlite3_file_control(handle, "main", SQLITE_FCNTL_VFS_POINTER, &vfs);
    return {Error{Error::Kind::io, name,
                  why_not_made("a file beside it, such as its -wal, cannot be made", vfs, name)}};
  }
  return {Error{kind_of_code(code, system), name == nullptr ? "" : name,
                with_system_error(std::move(what), system)}};
}

}  // namespace runstone::sql
