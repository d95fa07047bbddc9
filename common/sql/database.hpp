// sql::Database: a connection to a database. It says nothing about the database system:
// common/sqlite and common/postgres open databases, and tables are written once for both.
// Threads: one thread at a time owns a Database and all of its statements.
#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/sql/sql_error.hpp"
#include "common/sql/statement.hpp"

namespace runstone::sql {

/// The database systems, whose SQL differs in some places.
enum class Dialect { sqlite, postgres };

/// The interface that a database system implements. Database has the same calls and documents them.
class Connection {
 public:
  virtual ~Connection() = default;
  virtual Dialect dialect() const = 0;
  virtual const std::string& file() const = 0;
  virtual Result<void> run(const char* sql) = 0;
  virtual Result<Statement> prepare(std::string_view sql) = 0;
  virtual std::int64_t changes() = 0;
  virtual Result<void> flush() = 0;
  virtual Result<void> begin_write() = 0;
  virtual Result<void> commit() = 0;
  virtual Result<void> roll_back() = 0;
  virtual Result<void> begin_reads() = 0;
  virtual Result<void> end_reads() = 0;
  virtual bool is_connected() const { return true; }
};

class Database {
 public:
  explicit Database(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}

  Dialect dialect() const { return connection_->dialect(); }
  /// Returns the name of the database for messages: that of an SQLite file, or the address of a
  /// PostgreSQL database without its password.
  const std::string& file() const { return connection_->file(); }

  /// Runs one or more statements and discards their rows.
  Result<void> run(const char* sql) { return connection_->run(sql); }
  /// Parameters are `?1`, `?2` and so on.
  Result<Statement> prepare(std::string_view sql) { return connection_->prepare(sql); }
  /// Returns the first column of the first row. Fails if there is no row.
  Result<std::int64_t> integer(std::string_view sql);
  Result<std::string> text(std::string_view sql);
  /// Returns the number of rows that the last INSERT, UPDATE or DELETE changed.
  std::int64_t changes() { return connection_->changes(); }

  /// Waits until all statements of the transaction are carried out. Returns the first error.
  Result<void> flush() { return connection_->flush(); }
  /// Begins reads that see one moment of the database until end_reads(). They nest. In a write
  /// transaction they are parts of it.
  Result<void> begin_reads() { return connection_->begin_reads(); }
  Result<void> end_reads() { return connection_->end_reads(); }

  /// Returns false if the connection was lost: every call fails from then on. A loss is known after
  /// the first call that fails.
  bool is_connected() const { return connection_->is_connected(); }

  /// The calls of the database system itself.
  Connection& connection() { return *connection_; }

 private:
  /// Returns the statement at its first row. Fails if there is no row.
  Result<Statement> first_row(std::string_view sql);

  std::unique_ptr<Connection> connection_;
};

}  // namespace runstone::sql
