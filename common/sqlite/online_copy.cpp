#include "common/sqlite/online_copy.hpp"

#include <sqlite3.h>

#include <cerrno>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {
namespace {

/// Returns true if the file that is copied caused the error. SQLite reports every error with the
/// connection of the copy.
bool is_of_source(int code) {
  switch (code & 0xff) {
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return true;
    case SQLITE_IOERR:
      return code == SQLITE_IOERR_READ || code == SQLITE_IOERR_SHORT_READ ||
             code == SQLITE_IOERR_CORRUPTFS;
    default:
      return false;
  }
}

}  // namespace

void OnlineCopy::Finish::operator()(sqlite3_backup* handle) const { sqlite3_backup_finish(handle); }

Result<OnlineCopy> OnlineCopy::begin(Database& from, Database& to) {
  if (sqlite3_txn_state(sqlite_handle(from), "main") == SQLITE_TXN_NONE) {
    return failure(
        Error{Error::Kind::bad_statement, from.file(), "has no read transaction to copy"});
  }
  errno = 0;
  sqlite3_backup* handle =
      sqlite3_backup_init(sqlite_handle(to), "main", sqlite_handle(from), "main");
  if (handle == nullptr)
    return sqlite_failure(sqlite_handle(to), sqlite3_errcode(sqlite_handle(to)));
  return OnlineCopy(handle, from, to);
}

Result<bool> OnlineCopy::step(int pages) {
  errno = 0;
  const int code = sqlite3_backup_step(handle_.get(), pages);
  if (code == SQLITE_OK) return true;
  if (code == SQLITE_DONE) return false;
  const int system = errno;
  // SQLite reports the message with the connection of the copy only when the copy is finished.
  handle_.reset();
  errno = system;
  if (is_of_source(code)) return sqlite_failure(sqlite_handle(*from_), code, sqlite3_errstr(code));
  return sqlite_failure(sqlite_handle(*to_), code);
}

std::uint64_t OnlineCopy::pages_left() const {
  return static_cast<std::uint64_t>(sqlite3_backup_remaining(handle_.get()));
}

std::uint64_t OnlineCopy::page_count() const {
  return static_cast<std::uint64_t>(sqlite3_backup_pagecount(handle_.get()));
}

}  // namespace runstone::sql
