// A thin move-only layer over the SQLite C API: a database, its prepared statements and a transaction guard.
// Every failure becomes a StoreError that names the file. One thread at a time owns a Database and all of its
// statements (opened without SQLite's own mutex).
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/core/bytes.hpp"
#include "server/store/store.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace runstone::sql {

enum class Type { integer, text, blob, other };

/// A prepared statement, reused for as long as its database lives. Parameters count from 1, columns from 0.
class Statement {
 public:
  explicit Statement(sqlite3_stmt* handle) : handle_(handle) {}

  Statement& bind(int parameter, std::int64_t value);
  /// The bytes must live until run() returns, or until reset().
  Statement& bind(int parameter, ByteView value);
  Statement& bind(int parameter, std::string_view value);

  /// Next row; false when there is none.
  StoreResult<bool> step();
  /// For statements that give no rows: steps to the end and resets.
  StoreResult<void> run();
  /// Ready to be stepped again with what is bound, or with some of it bound anew. Views of columns die.
  void rewind();
  /// Ready to be bound and stepped again. Views of columns die.
  void reset();

  std::int64_t integer(int column) const;
  /// Both live until the next step() or reset().
  ByteView blob(int column) const;
  std::string_view text(int column) const;
  Type type(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int bind_error_ = 0;  // first code of a failed bind; step() reports it
};

/// Resets a statement when the scope ends, on every way out.
class ResetAtEnd {
 public:
  explicit ResetAtEnd(Statement& statement) : statement_(statement) {}
  ~ResetAtEnd() { statement_.reset(); }
  ResetAtEnd(const ResetAtEnd&) = delete;
  ResetAtEnd& operator=(const ResetAtEnd&) = delete;

 private:
  Statement& statement_;
};

class Database {
 public:
  enum class Mode {
    read,
    write,
    create,
    header
  };  // header: the main file alone, without locks and WAL

  /// `vfs`: name of an SQLite VFS; empty for the default.
  static StoreResult<Database> open(const std::string& file, Mode mode, const std::string& vfs);

  /// Runs statements that give no rows worth having.
  StoreResult<void> run(const char* sql);
  StoreResult<Statement> prepare(std::string_view sql);
  /// First column of the first row; an error when there is no row.
  StoreResult<std::int64_t> integer(std::string_view sql);
  StoreResult<std::string> text(std::string_view sql);

  /// First 100 bytes of the main file as they are on disk; nothing if it is shorter.
  std::optional<std::array<std::uint8_t, 100>> header();
  /// The main file, as opened.
  const std::string& file() const { return file_; }

 private:
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  Database(std::string file, sqlite3* handle) : file_(std::move(file)), handle_(handle) {}
  std::string file_;
  std::unique_ptr<sqlite3, Close> handle_;
};

/// Rolls back unless commit() succeeded.
class Transaction {
 public:
  static StoreResult<Transaction> begin(Database& database);
  Transaction(Transaction&& other) noexcept : database_(other.database_) {
    other.database_ = nullptr;
  }
  Transaction& operator=(Transaction&&) = delete;
  ~Transaction();
  StoreResult<void> commit();

 private:
  explicit Transaction(Database& database) : database_(&database) {}
  Database* database_;
};

}  // namespace runstone::sql
