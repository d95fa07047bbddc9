// LuantiMap: the rows of a Luanti world's map.sqlite, for reading only. Its one table has two
// layouts: blocks(pos, data), and blocks(x, y, z, data) since Luanti 5.12.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/sql/database.hpp"

namespace runstone {

class LuantiMap {
 public:
  /// Opens a map. The error is one line of text. One read transaction lasts as long as the object,
  /// so all calls read the same state of the map, even while Luanti writes to it.
  static Result<LuantiMap, std::string> open(const std::string& file);

  std::uint64_t row_count() const { return row_count_; }

  /// Calls `row` for every block, ascending by key. `data` is valid during that call. Fails if not
  /// all rows could be read.
  Result<void, std::string> each_row(
      const std::function<void(std::int64_t pos, ByteView data)>& row);

  /// Returns the bytes of one block, or nullopt if the row is missing or cannot be read. The bytes
  /// are valid until the next call. The caller knows from each_row() which rows exist, so both
  /// cases mean damage.
  std::optional<ByteView> find(std::int64_t pos);

 private:
  LuantiMap(sql::Database database, sql::Statement scan, sql::Statement find,
            std::uint64_t row_count)
      : database_(std::move(database)),
        scan_(std::move(scan)),
        find_(std::move(find)),
        row_count_(row_count) {}

  sql::Database database_;  // before its statements
  sql::Statement scan_, find_;
  std::uint64_t row_count_;
};

}  // namespace runstone
