// sql::Statement: a prepared statement of a Database.
// Threads: a statement belongs to the thread that owns its database.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>

#include "common/core/bytes.hpp"
#include "common/sqlite/sql_error.hpp"

struct sqlite3_stmt;

namespace runstone::sql {

enum class Type { integer, text, blob, other };

/// Parameters count from 1, columns from 0. A statement must not outlive its database.
class Statement {
 public:
  /// Makes an empty statement. Every call of step() fails.
  Statement() = default;
  explicit Statement(sqlite3_stmt* handle) : handle_(handle) {}

  /// Binds a parameter. A failure is kept, and the next step() returns it.
  Statement& bind(int parameter, std::int64_t value);
  /// Requires that the bytes live until run() returns or reset() is called.
  Statement& bind(int parameter, ByteView value);
  Statement& bind(int parameter, std::string_view value);
  /// Returns the number of the largest parameter.
  int parameter_count() const;

  /// Moves to the next row. Returns false if there is none.
  Result<bool> step();
  /// Steps to the end and resets. It is for statements without rows.
  Result<void> run();
  /// Makes the statement ready to be stepped again. Bound values stay; views of columns become
  /// invalid.
  void rewind();
  /// Makes the statement ready to be bound and stepped again. Views of columns become invalid.
  void reset();

  std::int64_t integer(int column) const;
  /// The views of blob() and text() are valid until the next step(), rewind() or reset().
  ByteView blob(int column) const;
  std::string_view text(int column) const;
  Type type(int column) const;

 private:
  struct Finalize {
    void operator()(sqlite3_stmt* handle) const;
  };
  std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  int bind_error_ = 0;  // code of the first bind that failed
};

/// Resets a statement when the scope ends.
class ResetAtEnd {
 public:
  explicit ResetAtEnd(Statement& statement) : statement_(statement) {}
  ~ResetAtEnd() { statement_.reset(); }
  ResetAtEnd(const ResetAtEnd&) = delete;
  ResetAtEnd& operator=(const ResetAtEnd&) = delete;

 private:
  Statement& statement_;
};

}  // namespace runstone::sql
