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

namespace runstone::sql {

/// Returns the error of the last call on a connection. `code` is the result of that call. A null
/// handle means that there was no memory for a connection.
Unexpected<Error> sqlite_failure(sqlite3* handle, int code);
/// Returns the system's error of the last call on a file that failed, or 0.
int last_error_of(sqlite3_file* file);
/// Returns `what` and, unless it is 0, the text and the number of a system's error.
std::string with_system_error(std::string what, int system);

class SqliteStatement final : public StatementHandle {
 public:
  explicit SqliteStatement(sqlite3_stmt* handle) : handle_(handle) {}
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
  Result<void> begin_write() override { return run("BEGIN IMMEDIATE"); }
  Result<void> commit() override { return run("COMMIT"); }
  Result<void> roll_back() override { return run("ROLLBACK"); }
  Result<void> begin_reads() override { return run("SAVEPOINT reads"); }
  Result<void> end_reads() override { return run("RELEASE reads"); }
  sqlite3* handle() { return handle_.get(); }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Requires a database of open_sqlite().
inline sqlite3* sqlite_handle(Database& database) {
  return static_cast<SqliteConnection&>(database.connection()).handle();
}

}  // namespace runstone::sql
