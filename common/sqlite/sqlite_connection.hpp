// SqliteConnection: sql::Connection and sql::StatementHandle on the SQLite C API.
// Threads: the one that owns the database.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/sql/database.hpp"

struct sqlite3;
struct sqlite3_file;
struct sqlite3_stmt;
struct sqlite3_vfs;

namespace runstone::sql {

/// Returns the error of the last call on a connection. `code` is the result of that call. A null
/// handle means that there was no memory for a connection. Requires that errno was 0 before the call:
/// for some errors only errno has the reason.
Unexpected<Error> sqlite_failure(sqlite3* handle, int code);
/// Returns the error of a call that SQLite reports with another connection.
Unexpected<Error> sqlite_failure(sqlite3* handle, int code, std::string what);
/// Returns true for the errors of a read that SQLite reports as damage.
bool is_of_reading(int system);
/// Returns `system` if it is an error that a disk or its rights can cause, otherwise 0.
int disk_error(int system);
/// Returns the system's error of the last call on a file that failed, or 0.
int last_error_of(sqlite3_file* file);
/// Returns `what` and, unless it is 0, the text and the number of a system's error.
std::string with_system_error(std::string what, int system);
/// Completes an error about a file that could not be made. SQLite then tries to open that file for
/// reading, so that the reason is lost. So this makes and removes another file beside `file`, through
/// the same calls of the system. `vfs` may be null.
std::string why_not_made(std::string what, sqlite3_vfs* vfs, const std::string& file);
/// Returns the error about a file that was opened for reading alone. `system` is the system's error
/// of opening it for writing, or 0 if it is not known.
std::string why_read_only(int system);

class SqliteStatement final : public StatementHandle {
 public:
  /// `is_in_write` is true during a write transaction. Requires that it outlives the object.
  SqliteStatement(sqlite3_stmt* handle, const bool& is_in_write)
      : handle_(handle), is_in_write_(is_in_write) {}
  void bind(int parameter, std::int64_t value) override;
  void bind(int parameter, ByteView value) override;
  void bind(int parameter, std::string_view value) override;
  int parameter_count() const override;
  Result<bool> step() override;
  Result<void> run() override;
  void rewind() override;
  void reset() override;
  std::int64_t integer(int column) const override;
  ByteView blob(int column) const override;
  Type type(int column) const override;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  const bool& is_in_write_;
  int bind_error_ = 0;  // code of the first bind that failed
};

class SqliteConnection final : public Connection {
 public:
  SqliteConnection(std::string file, sqlite3* handle) : file_(std::move(file)), handle_(handle) {}
  Dialect dialect() const override { return Dialect::sqlite; }
  const std::string& file() const override { return file_; }
  Result<void> run(const char* sql) override;
  Result<Statement> prepare(std::string_view sql) override;
  std::int64_t changes() override;
  Result<void> flush() override { return {}; }  // nothing is ever postponed
  Result<void> begin_write() override;
  Result<void> commit() override;
  Result<void> roll_back() override;
  Result<void> begin_reads() override { return run("SAVEPOINT reads"); }
  Result<void> end_reads() override { return run("RELEASE reads"); }
  sqlite3* handle() { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
  bool is_in_write_ = false;  // between begin_write() and the commit, or roll_back()
};

/// Fails if a write transaction is open for its owner and SQLite has rolled it back, as it does after
/// some errors. Otherwise each later statement would be a transaction of its own, and half of the work
/// would stay.
Result<void> check_transaction(sqlite3* handle, bool is_in_write);

/// Requires a database of open_sqlite().
inline sqlite3* sqlite_handle(Database& database) {
  return static_cast<SqliteConnection&>(database.connection()).handle();
}

}  // namespace runstone::sql
