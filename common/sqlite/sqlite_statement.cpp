#include <sqlite3.h>

#include <cerrno>

#include "common/sqlite/sqlite_connection.hpp"

namespace runstone::sql {

void SqliteStatement::Finalize::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

void SqliteStatement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(handle_.get(), parameter, value);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
}

void SqliteStatement::bind(int parameter, ByteView value) {
  // An empty view may have a null pointer, which SQLite would store as NULL.
  const int code = value.empty() ? sqlite3_bind_zeroblob(handle_.get(), parameter, 0)
                                 : sqlite3_bind_blob64(handle_.get(), parameter, value.data(),
                                                       value.size(), SQLITE_STATIC);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
}

void SqliteStatement::bind(int parameter, std::string_view value) {
  const int code = sqlite3_bind_text64(handle_.get(), parameter, value.empty() ? "" : value.data(),
                                       value.size(), SQLITE_STATIC, SQLITE_UTF8);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
}

int SqliteStatement::parameter_count() const { return sqlite3_bind_parameter_count(handle_.get()); }

Result<bool> SqliteStatement::step() {
  sqlite3* const connection = sqlite3_db_handle(handle_.get());
  if (const auto lives = check_transaction(connection, is_in_write_); !lives)
    return failure(lives.error());
  errno = 0;
  const int code = bind_error_ != SQLITE_OK ? bind_error_ : sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return sqlite_failure(connection, code);
}

Result<void> SqliteStatement::run() {
  Result<void> done;
  for (;;) {
    const auto row = step();
    if (!row) done = failure(row.error());
    if (!row || !*row) break;
  }
  reset();
  return done;
}

void SqliteStatement::rewind() { sqlite3_reset(handle_.get()); }

void SqliteStatement::reset() {
  sqlite3_reset(handle_.get());
  sqlite3_clear_bindings(handle_.get());
  bind_error_ = SQLITE_OK;
}

std::int64_t SqliteStatement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

ByteView SqliteStatement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  return {data, data == nullptr
                    ? 0
                    : static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

Type SqliteStatement::type(int column) const {
  switch (sqlite3_column_type(handle_.get(), column)) {
    case SQLITE_INTEGER:
      return Type::integer;
    case SQLITE_TEXT:
      return Type::text;
    case SQLITE_BLOB:
      return Type::blob;
    default:
      return Type::other;
  }
}

}  // namespace runstone::sql
