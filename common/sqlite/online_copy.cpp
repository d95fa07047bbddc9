#include "common/sqlite/online_copy.hpp"

#include <sqlite3.h>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {

void OnlineCopy::Finish::operator()(sqlite3_backup* handle) const { sqlite3_backup_finish(handle); }

Result<OnlineCopy> OnlineCopy::begin(Database& from, Database& to) {
  if (sqlite3_txn_state(sqlite_handle(from), "main") == SQLITE_TXN_NONE) {
    return failure(
        Error{Error::Kind::bad_statement, from.file(), "has no read transaction to copy"});
  }
  sqlite3_backup* handle =
      sqlite3_backup_init(sqlite_handle(to), "main", sqlite_handle(from), "main");
  if (handle == nullptr)
    return sqlite_failure(sqlite_handle(to), sqlite3_errcode(sqlite_handle(to)));
  return OnlineCopy(handle, to);
}

Result<bool> OnlineCopy::step(int pages) {
  const int code = sqlite3_backup_step(handle_.get(), pages);
  if (code == SQLITE_OK) return true;
  if (code == SQLITE_DONE) return false;
  // SQLite reports the message with the connection of the copy only when the copy is finished.
  handle_.reset();
  return sqlite_failure(sqlite_handle(*to_), code);
}

std::uint64_t OnlineCopy::pages_left() const {
  return static_cast<std::uint64_t>(sqlite3_backup_remaining(handle_.get()));
}

std::uint64_t OnlineCopy::page_count() const {
  return static_cast<std::uint64_t>(sqlite3_backup_pagecount(handle_.get()));
}

}  // namespace runstone::sql
