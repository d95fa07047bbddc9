#include "client/cache/cache_database.hpp"

#include <sqlite3.h>

namespace runstone {

// ---- statements

CacheDatabase::Statement::Statement(CacheDatabase& database, const char* sql)
    : database_(&database) {
  if (!database.ok()) return;
  sqlite3_stmt* made = nullptr;
  database.take(sqlite3_prepare_v3(database.handle_.get(), sql, -1, SQLITE_PREPARE_PERSISTENT,
                                   &made, nullptr));
  handle_.reset(made);
}

void CacheDatabase::Statement::Finalize::operator()(sqlite3_stmt* handle) const {
  sqlite3_finalize(handle);
}

CacheDatabase::Statement& CacheDatabase::Statement::bind(int parameter, std::int64_t value) {
  if (database_->ok()) database_->take(sqlite3_bind_int64(handle_.get(), parameter, value));
  return *this;
}

CacheDatabase::Statement& CacheDatabase::Statement::bind(int parameter, ByteView value) {
  if (database_->ok()) {
    database_->take(
        sqlite3_bind_blob64(handle_.get(), parameter, value.data(), value.size(), SQLITE_STATIC));
  }
  return *this;
}

bool CacheDatabase::Statement::step() {
  if (!database_->ok()) return false;
  const int code = sqlite3_step(handle_.get());
  if (code != SQLITE_ROW && code != SQLITE_DONE) database_->take(code);
  return code == SQLITE_ROW;
}

void CacheDatabase::Statement::run() {
  while (step()) {
  }
  reset();
}

void CacheDatabase::Statement::reset() {
  if (!handle_) return;
  sqlite3_reset(handle_.get());  // says again what step() said
  sqlite3_clear_bindings(handle_.get());
}

std::int64_t CacheDatabase::Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

ByteView CacheDatabase::Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  return {data, data == nullptr
                    ? 0
                    : static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

// ---- the database

void CacheDatabase::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

CacheDatabase::CacheDatabase(const std::string& file) {
  sqlite3* made = nullptr;
  const int flags =
      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE;
  const int code = sqlite3_open_v2(file.c_str(), &made, flags, nullptr);
  handle_.reset(made);
  take(code);
}

void CacheDatabase::take(int code) {
  if (code == SQLITE_OK || code_ != SQLITE_OK) return;
  code_ = code;
  error_ = handle_ ? sqlite3_errmsg(handle_.get()) : sqlite3_errstr(code);
}

bool CacheDatabase::is_corrupt() const {
  const int kind = code_ & 0xff;
  // A table or column that is missing: somebody else's database, or one that was damaged into another shape.
  return kind == SQLITE_CORRUPT || kind == SQLITE_NOTADB || kind == SQLITE_ERROR ||
         kind == SQLITE_CONSTRAINT;
}

void CacheDatabase::run(const char* sql) {
  if (ok()) take(sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr));
}

std::int64_t CacheDatabase::integer(const char* sql) {
  Statement statement(*this, sql);
  return statement.step() ? statement.integer(0) : 0;
}

std::int64_t CacheDatabase::changes() const { return sqlite3_changes64(handle_.get()); }

}  // namespace runstone
