// PostgresConnection: sql::Connection and sql::StatementHandle on libpq.
// Threads: the one that owns the database.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/postgres/postgres_text.hpp"
#include "common/sql/database.hpp"

struct pg_conn;    // PGconn of libpq
struct pg_result;  // PGresult of libpq

namespace runstone::sql {

struct ClearResult {
  void operator()(pg_result* result) const;
};
using PostgresResult = std::unique_ptr<pg_result, ClearResult>;
struct FinishConnection {
  void operator()(pg_conn* handle) const;
};
using ConnectionHandle = std::unique_ptr<pg_conn, FinishConnection>;

/// Returns the first line of the last error of a connection. The others are advice.
std::string connection_message(pg_conn* handle);
/// Returns the error of a result, or of the connection if the result is null. `name` is that of the
/// database in messages.
Error result_error(pg_conn* handle, const std::string& name, const pg_result* result);

/// A statement that the server has prepared.
struct PreparedText {
  std::string name;
  std::vector<int> slots;
};

/// The values of a statement's parameters, in the form that libpq takes.
struct PostgresValues {
  std::vector<const char*> data;  // null: NULL
  std::vector<int> sizes;
};

class PostgresConnection final : public Connection {
 public:
  PostgresConnection(std::string name, ConnectionHandle handle)
      : name_(std::move(name)), handle_(std::move(handle)) {}

  Dialect dialect() const override { return Dialect::postgres; }
  const std::string& file() const override { return name_; }
  Result<void> run(const char* sql) override;
  Result<Statement> prepare(std::string_view sql) override;
  std::int64_t changes() override;
  Result<void> flush() override { return drain(); }
  Result<void> begin_write() override;
  Result<void> commit() override;
  Result<void> roll_back() override;
  Result<void> begin_reads() override;
  Result<void> end_reads() override;
  bool is_connected() const override;

  /// Carries out a prepared statement and returns its result, after all statements that were sent
  /// before.
  Result<PostgresResult> execute(const PreparedText& statement, const PostgresValues& values);
  /// Sends a prepared statement without rows. In a write transaction it does not wait for the
  /// answer.
  Result<void> send(const PreparedText& statement, const PostgresValues& values);

 private:
  /// Ends a transaction whose end has failed. Otherwise the next one would become a part of it.
  Result<void> end_left_transaction();
  /// Sends a statement in pipeline mode.
  Result<void> enqueue(const PreparedText& statement, const PostgresValues& values);
  /// Waits for the answers of all statements that were sent. Returns the first error. Sets `last`
  /// to the result of the last one.
  Result<void> drain(PostgresResult* last = nullptr);
  /// Returns the error of a result, or of the connection if the result is null.
  Unexpected<Error> result_failure(const pg_result* result) const;
  /// Keeps the number of rows that a statement has changed. Fails with the error of its result.
  Result<void> take(const pg_result* result);

  std::string name_;
  ConnectionHandle handle_;
  std::map<std::string, PreparedText, std::less<>> prepared_;  // by the text of Database::prepare()
  std::size_t sent_ = 0;  // statements without an answer so far; above 0 in pipeline mode only
  bool is_writing_ = false;
  unsigned reads_ = 0;  // begin_reads() without end_reads()
  std::int64_t changes_ = 0;
  std::optional<Error> unreported_;  // of a statement that was sent, for the next call
};

class PostgresStatement final : public StatementHandle {
 public:
  /// The connection outlives the statement, and so does the text, which the connection keeps.
  PostgresStatement(PostgresConnection& connection, const PreparedText& text)
      : connection_(connection), text_(text), values_(text.slots.size()) {}
  void bind(int parameter, std::int64_t value) override;
  void bind(int parameter, ByteView value) override;
  void bind(int parameter, std::string_view value) override;
  int parameter_count() const override { return static_cast<int>(text_.slots.size()); }
  Result<bool> step() override;
  Result<void> run() override;
  void rewind() override;
  void reset() override;
  std::int64_t integer(int column) const override;
  ByteView blob(int column) const override;
  Type type(int column) const override;

 private:
  struct Value {
    std::array<char, 8> integer{};  // big-endian
    const char* data = nullptr;     // null: NULL
    std::size_t size = 0;
    bool is_integer = false;  // its data is `integer`
  };
  Value* value_of(int parameter);
  PostgresValues values() const;
  Unexpected<Error> bad_bind() const;

  PostgresConnection& connection_;
  const PreparedText& text_;
  std::vector<Value> values_;  // by parameter
  bool has_bad_bind_ = false;  // bind() was called with a number that no parameter has
  PostgresResult result_;
  int row_ = -1;
};

}  // namespace runstone::sql
