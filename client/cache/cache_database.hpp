// CacheDatabase: a thin layer over the SQLite C API for the chunk cache. The first failure sticks: after it every call
// fails and does nothing, so a caller may write a whole batch and ask ok() once. One thread.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/bytes.hpp"

struct sqlite3;
struct sqlite3_stmt;

namespace runstone {

class CacheDatabase {
 public:
  /// A prepared statement. Parameters count from 1, columns from 0. Must not outlive its database.
  class Statement {
   public:
    Statement() = default;
    Statement(CacheDatabase& database, const char* sql);
    Statement& bind(int parameter, std::int64_t value);
    /// The bytes must live until reset().
    Statement& bind(int parameter, ByteView value);
    /// Next row; false at the end and after a failure.
    bool step();
    /// Steps to the end, then resets.
    void run();
    void reset();
    std::int64_t integer(int column) const;
    /// Lives until the next step() or reset().
    ByteView blob(int column) const;

   private:
    struct Finalize {
      void operator()(sqlite3_stmt* handle) const;
    };
    CacheDatabase* database_ = nullptr;
    std::unique_ptr<sqlite3_stmt, Finalize> handle_;
  };

  /// Opens or makes the file; ask ok().
  explicit CacheDatabase(const std::string& file);

  bool ok() const { return code_ == 0; }
  /// The file is damaged or no database, as far as the failure tells.
  bool is_corrupt() const;
  const std::string& error() const { return error_; }

  void run(const char* sql);
  /// The first column of the first row; 0 without one.
  std::int64_t integer(const char* sql);
  /// Rows changed by the last statement.
  std::int64_t changes() const;

 private:
  void take(int code);
  struct Close {
    void operator()(sqlite3* handle) const;
  };
  std::unique_ptr<sqlite3, Close> handle_;
  int code_ = 0;
  std::string error_;
};

}  // namespace runstone
