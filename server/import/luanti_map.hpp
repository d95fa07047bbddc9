// LuantiMap: the rows of another program's map.sqlite, read-only. Knows both layouts of its one table:
// blocks(pos, data), and blocks(x, y, z, data) of Luanti 5.12 and later.
#pragma once
#include <sqlite3.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

class LuantiMap {
 public:
  /// The error is one line of text. All reads see the map as it is now, even while its owner writes to it.
  static Result<LuantiMap, std::string> open(const std::string& file);

  std::uint64_t row_count() const { return row_count_; }

  /// Calls `row` for every block in ascending key. The bytes live for the call. Returns what went wrong, if
  /// anything.
  std::optional<std::string> each_row(
      const std::function<void(std::int64_t pos, ByteView data)>& row);

  /// One block's bytes, which live until the next call; none if there is no such row. An I/O error reads as
  /// none: the caller has seen the row in each_row() and reports its absence.
  std::optional<ByteView> find(std::int64_t pos);

 private:
  struct Close {
    void operator()(sqlite3* db) const { sqlite3_close_v2(db); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;

  Statement prepare(const std::string& sql);
  std::string trouble() const { return sqlite3_errmsg(db_.get()); }

  std::unique_ptr<sqlite3, Close> db_;
  Statement scan_, find_;
  std::uint64_t row_count_ = 0;
};

}  // namespace runstone
