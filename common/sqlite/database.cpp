#include "common/sqlite/database.hpp"

#include <sqlite3.h>

#include <utility>

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
    return Unexpected<Error>{{Error::Kind::io, file, "no SQLite VFS is called " + vfs}};
  int there = 0;
  if (system->xAccess(system, file.c_str(), SQLITE_ACCESS_EXISTS, &there) != SQLITE_OK)
    return Unexpected<Error>{{Error::Kind::io, file, "cannot be looked up"}};
  return there != 0;
}

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

Result<Database> Database::open(const std::string& file, Mode mode, const std::string& vfs) {
  int flags = SQLITE_OPEN_URI | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  std::string uri = uri_of(file);
  switch (mode) {
    case Mode::read:
      flags |= SQLITE_OPEN_READONLY;
      break;
    case Mode::write:
      flags |= SQLITE_OPEN_READWRITE;
      break;
    case Mode::create:
      flags |= SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE;
      break;
    case Mode::header:
      flags |= SQLITE_OPEN_READONLY;
      uri += "?immutable=1";
      break;
  }
  sqlite3* handle = nullptr;
  const int code =
      sqlite3_open_v2(uri.c_str(), &handle, flags, vfs.empty() ? nullptr : vfs.c_str());
  Database database(file, handle);
  if (code != SQLITE_OK) {
    auto error = failure(handle, code);
    error.error.file = file;
    return error;
  }
  sqlite3_busy_timeout(handle, kBusyMsMax);
  return database;
}

Result<void> Database::run(const char* sql) {
  const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return failure(handle_.get(), code);
  return {};
}

Result<Statement> Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(handle_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return failure(handle_.get(), code);
  return Statement(statement);
}

Result<Statement> Database::first_row(std::string_view sql) {
  auto statement = prepare(sql);
  if (!statement) return statement;
  const auto row = statement->step();
  if (!row) return Unexpected<Error>{row.error()};
  if (!*row) return failure(handle_.get(), SQLITE_CORRUPT);
  return statement;
}

Result<std::int64_t> Database::integer(std::string_view sql) {
  const auto row = first_row(sql);
  if (!row) return Unexpected<Error>{row.error()};
  return row->integer(0);
}

Result<std::string> Database::text(std::string_view sql) {
  const auto row = first_row(sql);
  if (!row) return Unexpected<Error>{row.error()};
  return std::string(row->text(0));
}

std::int64_t Database::changes() const { return sqlite3_changes64(handle_.get()); }

void Database::keep_wal_on_close(bool keep) {
  sqlite3_db_config(handle_.get(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, keep ? 1 : 0, nullptr);
}

std::optional<std::array<std::uint8_t, 100>> Database::header() {
  // The bytes are read through SQLite's descriptor. Closing another descriptor of the file would
  // drop this process's locks on it (POSIX).
  sqlite3_file* file = nullptr;
  std::array<std::uint8_t, 100> bytes{};
  if (sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK ||
      file->pMethods == nullptr ||
      file->pMethods->xRead(file, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK) {
    return std::nullopt;
  }
  return bytes;
}

}  // namespace runstone::sql
