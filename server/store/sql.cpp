#include "server/store/sql.hpp"

#include <sqlite3.h>

#include <utility>

namespace runstone::sql {

namespace {

// A reader may meet the writer's short exclusive moments (recovery, the end of a checkpoint).
constexpr int kBusyMsMax = 2000;

StoreError::Kind kind_of_code(int code) {
  switch (code & 0xff) {
    case SQLITE_FULL:
      return StoreError::Kind::full;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return StoreError::Kind::corrupt;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return StoreError::Kind::locked;
    case SQLITE_CONSTRAINT:
      return StoreError::Kind::bad_request;
    default:
      return StoreError::Kind::io;
  }
}

Unexpected<StoreError> failure(sqlite3* handle, int code) {
  const char* name = sqlite3_db_filename(handle, "main");
  std::string what = sqlite3_errmsg(handle);
  if (const int system = sqlite3_system_errno(handle);
      system != 0 && (code & 0xff) != SQLITE_CONSTRAINT) {
    what += " (system error " + std::to_string(system) + ")";
  }
  return {StoreError{kind_of_code(code), name == nullptr ? "" : name, "", std::move(what)}};
}

std::string uri_of(const std::string& file) {
  std::string uri = "file:";
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

void Statement::Finalize::operator()(sqlite3_stmt* handle) const { sqlite3_finalize(handle); }

Statement& Statement::bind(int parameter, std::int64_t value) {
  const int code = sqlite3_bind_int64(handle_.get(), parameter, value);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
  return *this;
}

Statement& Statement::bind(int parameter, ByteView value) {
  // An empty view may have a null pointer, which SQLite would store as NULL.
  const int code = value.empty() ? sqlite3_bind_zeroblob(handle_.get(), parameter, 0)
                                 : sqlite3_bind_blob64(handle_.get(), parameter, value.data(),
                                                       value.size(), SQLITE_STATIC);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
  return *this;
}

Statement& Statement::bind(int parameter, std::string_view value) {
  const int code = sqlite3_bind_text64(handle_.get(), parameter, value.empty() ? "" : value.data(),
                                       value.size(), SQLITE_STATIC, SQLITE_UTF8);
  if (bind_error_ == SQLITE_OK) bind_error_ = code;
  return *this;
}

StoreResult<bool> Statement::step() {
  const int code = bind_error_ != SQLITE_OK ? bind_error_ : sqlite3_step(handle_.get());
  if (code == SQLITE_ROW) return true;
  if (code == SQLITE_DONE) return false;
  return failure(sqlite3_db_handle(handle_.get()), code);
}

StoreResult<void> Statement::run() {
  const ResetAtEnd reset_at_end(*this);
  for (;;) {
    const auto row = step();
    if (!row) return Unexpected<StoreError>{row.error()};
    if (!*row) return {};
  }
}

void Statement::rewind() { sqlite3_reset(handle_.get()); }

void Statement::reset() {
  sqlite3_reset(handle_.get());
  sqlite3_clear_bindings(handle_.get());
  bind_error_ = SQLITE_OK;
}

std::int64_t Statement::integer(int column) const {
  return sqlite3_column_int64(handle_.get(), column);
}

ByteView Statement::blob(int column) const {
  const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(handle_.get(), column));
  return {data, data == nullptr
                    ? 0
                    : static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

std::string_view Statement::text(int column) const {
  const ByteView bytes = blob(column);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Type Statement::type(int column) const {
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

void Database::Close::operator()(sqlite3* handle) const { sqlite3_close_v2(handle); }

StoreResult<Database> Database::open(const std::string& file, Mode mode, const std::string& vfs) {
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

StoreResult<void> Database::run(const char* sql) {
  const int code = sqlite3_exec(handle_.get(), sql, nullptr, nullptr, nullptr);
  if (code != SQLITE_OK) return failure(handle_.get(), code);
  return {};
}

StoreResult<Statement> Database::prepare(std::string_view sql) {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v3(handle_.get(), sql.data(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &statement, nullptr);
  if (code != SQLITE_OK) return failure(handle_.get(), code);
  return Statement(statement);
}

StoreResult<std::int64_t> Database::integer(std::string_view sql) {
  auto statement = prepare(sql);
  if (!statement) return Unexpected<StoreError>{statement.error()};
  const auto row = statement->step();
  if (!row) return Unexpected<StoreError>{row.error()};
  if (!*row) return failure(handle_.get(), SQLITE_CORRUPT);
  return statement->integer(0);
}

StoreResult<std::string> Database::text(std::string_view sql) {
  auto statement = prepare(sql);
  if (!statement) return Unexpected<StoreError>{statement.error()};
  const auto row = statement->step();
  if (!row) return Unexpected<StoreError>{row.error()};
  if (!*row) return failure(handle_.get(), SQLITE_CORRUPT);
  return std::string(statement->text(0));
}

std::optional<std::array<std::uint8_t, 100>> Database::header() {
  // Through SQLite's own descriptor: closing another one would drop this process's locks on the file (POSIX).
  sqlite3_file* file = nullptr;
  std::array<std::uint8_t, 100> bytes{};
  if (sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK ||
      file->pMethods == nullptr ||
      file->pMethods->xRead(file, bytes.data(), static_cast<int>(bytes.size()), 0) != SQLITE_OK) {
    return std::nullopt;
  }
  return bytes;
}

StoreResult<Transaction> Transaction::begin(Database& database) {
  if (const auto begun = database.run("BEGIN IMMEDIATE"); !begun)
    return Unexpected<StoreError>{begun.error()};
  return Transaction(database);
}

Transaction::~Transaction() {
  // A failed COMMIT may have rolled back by itself; then this ROLLBACK fails, and nothing is left to undo.
  if (database_ != nullptr) static_cast<void>(database_->run("ROLLBACK").has_value());
}

StoreResult<void> Transaction::commit() {
  auto done = database_->run("COMMIT");
  if (done) database_ = nullptr;
  return done;
}

}  // namespace runstone::sql
