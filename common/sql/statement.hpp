// sql::Statement: a prepared statement of a Database.
// Threads: a statement belongs to the thread that owns its database.
#pragma once
#include <cstdint>
#include <memory>
#include <string_view>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/sql/sql_error.hpp"

namespace runstone::sql {

enum class Type { integer, text, blob, other };

/// The interface that a database system implements. Statement has the same calls and documents
/// them.
class StatementHandle {
 public:
  virtual ~StatementHandle() = default;
  virtual void bind(int parameter, std::int64_t value) = 0;
  virtual void bind(int parameter, ByteView value) = 0;
  virtual void bind(int parameter, std::string_view value) = 0;
  virtual int parameter_count() const = 0;
  virtual Result<bool> step() = 0;
  virtual Result<void> run() = 0;
  virtual void rewind() = 0;
  virtual void reset() = 0;
  virtual std::int64_t integer(int column) const = 0;
  virtual ByteView blob(int column) const = 0;
  virtual Type type(int column) const = 0;
};

/// Parameters count from 1, columns from 0. A statement must not outlive its database.
class Statement {
 public:
  /// Makes an empty statement. Every call of step() fails.
  Statement() = default;
  explicit Statement(std::unique_ptr<StatementHandle> handle) : handle_(std::move(handle)) {}

  /// Binds a parameter. A failure is kept, and the next step() returns it.
  Statement& bind(int parameter, std::int64_t value) { return bind_any(parameter, value); }
  /// Requires that the bytes live until run() returns or reset() is called.
  Statement& bind(int parameter, ByteView value) { return bind_any(parameter, value); }
  Statement& bind(int parameter, std::string_view value) { return bind_any(parameter, value); }
  /// Returns the number of the largest parameter.
  int parameter_count() const { return handle_->parameter_count(); }

  /// Moves to the next row. Returns false if there is none.
  Result<bool> step();
  /// Carries the statement out and resets it. It is for statements without rows. A database may
  /// postpone it to the next call that needs an answer, at the latest to the end of the
  /// transaction. That call returns the error.
  Result<void> run();
  /// Makes the statement ready to be stepped again. Bound values stay; views of columns become
  /// invalid.
  void rewind() { handle_->rewind(); }
  /// Makes the statement ready to be bound and stepped again. Views of columns become invalid.
  void reset() {
    if (handle_) handle_->reset();
  }

  std::int64_t integer(int column) const { return handle_->integer(column); }
  /// The views of blob() and text() are valid until the next step(), rewind() or reset().
  ByteView blob(int column) const { return handle_->blob(column); }
  std::string_view text(int column) const {
    const ByteView bytes = blob(column);
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  Type type(int column) const { return handle_->type(column); }

 private:
  template <class T>
  Statement& bind_any(int parameter, T value) {
    if (handle_) handle_->bind(parameter, value);
    return *this;
  }

  std::unique_ptr<StatementHandle> handle_;
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
