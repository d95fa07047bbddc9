#include "common/sqlite/sqlite_connection.hpp"

#include <sqlite3.h>

#include <cerrno>

#include "common/sqlite/sqlite_file.hpp"

namespace runstone::sql {
namespace {

// The time that a connection waits for a lock. A writer holds the file exclusively during recovery
// and at the end of a checkpoint.
constexpr int kBusyMsMax = 2000;

/// Returns the URI of a file. Characters with a special meaning in a URI are escaped.
std::string uri_of(const std::string& file) {
  // A path that begins with "//" would read as the name of a host; an empty host comes before it.
  std::string uri = file.starts_with("//") ? "file://" : "file:";
  constexpr char kHex[] = "0123456789abcdef";
  for (const char c : file) {
    if (c == '%' || c == '?' || c == '#') {
      const auto byte = static_cast<unsigned char>(c);
      uri += '%';
      uri += kHex[byte >> 4];
      uri += kHex[byte & 15];
    } else {
      uri += c;
    }
  }
  return uri;
}

}  // namespace

Result<bool> file_exists(const std::string& file, const std::string& vfs) {
  sqlite3_vfs* system = sqlite3_vfs_find(vfs.empty() ? nullptr : vfs.c_str());
  if (system == nullptr)
    return failure(Error{Error::Kind::io, file, "no SQLite VFS is called " + vfs});
  int there = 0;
  errno = 0;
  const int code = system->xAccess(system, file.c_str(), SQLITE_ACCESS_EXISTS, &there);
  // SQLite's VFS takes a file that cannot be looked up for one that is not there.
  const bool is_known = there != 0 || errno == 0 || errno == ENOENT || errno == ENOTDIR;
  if (code != SQLITE_OK || !is_known) {
    return failure(Error{Error::Kind::io, file, with_system_error("cannot be looked up", errno)});
  }
  return there != 0;
}

void SqliteConnection::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Result<Database> open_sqlite(const std::string& file, SqliteMode mode, const std::string& vfs) {
  int flags = SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  std::string uri = uri_of(file);
  switch (mode) {
    case SqliteMode::read:
      flags |= SQLITE_OPEN_READONLY;
      break;
    case SqliteMode::write:
      flags |= SQLITE_OPEN_READWRITE;
      break;
    case SqliteMode::create:
      flags |= SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
      break;
    case SqliteMode::header:
      flags |= SQLITE_OPEN_READONLY;
      uri += "?immutable=1";
      break;
  }
  sqlite3* handle = nullptr;
  const char* const vfs_name = vfs.empty() ? nullptr : vfs.c_str();
  errno = 0;
  const int code = sqlite3_open_v2(uri.c_str(), &handle, flags, vfs_name);
  const int system = errno;
  Database database(std::make_unique<SqliteConnection>(file, handle));
  if (code != SQLITE_OK) {
    errno = system;
    auto error = sqlite_failure(handle, code);
    error.error.file = file;
    if (mode == SqliteMode::create && (code & 0xff) == SQLITE_CANTOPEN)
      error.error.what = why_not_made("cannot be made", sqlite3_vfs_find(vfs_name), file);
    return error;
  }
  // A file that cannot be opened for writing SQLite opens for reading.
  const bool is_for_writing = mode == SqliteMode::write || mode == SqliteMode::create;
  if (is_for_writing && sqlite3_db_readonly(handle, "main") == 1) {
    return failure(Error{Error::Kind::io, file, why_read_only(system)});
  }
  sqlite3_busy_timeout(handle, kBusyMsMax);
  return database;
}

Result<void> check_transaction(sqlite3* handle, bool is_in_write) {
  if (!is_in_write || sqlite3_get_autocommit(handle) == 0) return {};
  return failure(Error{Error::Kind::io, sqlite3_db_filename(handle, "main"),
                       "an error before has rolled the transaction back"});
}

Result<void> SqliteConnection::begin_write() {
  auto begun = run("BEGIN IMMEDIATE");
  if (begun) is_in_write_ = true;
  return begun;
}

Result<void> SqliteConnection::commit() {
  auto committed = run("COMMIT");
  if (committed) is_in_write_ = false;
  return committed;
}

Result<void> SqliteConnection::roll_back() {
  is_in_write_ = false;
  return run("ROLLBACK");
}

Result<void> SqliteConnection::run(const char* sql) {
  if (auto lives = check_transaction(handle_.get(), is_in_write_); !lives) return lives;
  errno = 0;
  const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return sqlite_failure(handle_.get(), code);
  return {};
}

Result<Statement> SqliteConnection::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  errno = 0;
  const int code = sqlite3_prepare_v3(handle_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return sqlite_failure(handle_.get(), code);
  return Statement(std::make_unique<SqliteStatement>(statement, is_in_write_));
}

std::int64_t SqliteConnection::changes() { return sqlite3_changes64(handle_.get()); }

void keep_wal_on_close(Database& database, bool keep) {
  sqlite3_db_config(sqlite_handle(database), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, keep ? 1 : 0,
                    nullptr);
}

Result<std::string> check_structure(Database& database) {
  auto verdict = database.text("PRAGMA integrity_check(1)");
  const int system = errno;  // of the last call that read
  if (!verdict || *verdict == "ok" || !is_of_reading(system)) return verdict;
  return failure(
      Error{Error::Kind::io, database.file(), with_system_error("cannot be read", system)});
}

Result<std::optional<SqliteHeader>> file_header(Database& database) {
  // The bytes are read through SQLite's descriptor. Closing another descriptor of the file would
  // drop this process's locks on it (POSIX).
  sqlite3_file* file = nullptr;
  SqliteHeader bytes{};
  if (sqlite3_file_control(sqlite_handle(database), "main", SQLITE_FCNTL_FILE_POINTER, &file) !=
          SQLITE_OK ||
      file->pMethods == nullptr)
    return failure(Error{Error::Kind::io, database.file(), "cannot be read"});
  const int code = file->pMethods->xRead(file, bytes.data(), static_cast<int>(bytes.size()), 0);
  if (code == SQLITE_OK) return std::optional(bytes);
  if (code == SQLITE_IOERR_SHORT_READ) return std::optional<SqliteHeader>();
  return failure(Error{Error::Kind::io, database.file(),
                       with_system_error("cannot be read", last_error_of(file))});
}

}  // namespace runstone::sql
