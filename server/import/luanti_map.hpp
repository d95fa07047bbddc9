// LuantiMap: the rows of a Luanti world's map.sqlite, for reading only. Its one table has two
// layouts: blocks(pos, data), and blocks(x, y, z, data) since Luanti 5.12.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/sql/database.hpp"

namespace runstone {

struct LuantiRow {
  std::int64_t pos = 0;  // the key, also of a row with x, y and z
  ChunkCoord block;      // the position, in blocks of 16
  /// False if the key is no position of a block: it is no number, or out of range.
  bool is_placed = false;
  ByteView data;  // valid during the call
};

class LuantiMap {
 public:
  /// Opens a map. The error is one line of text, and says what to do if the map is in use or has a
  /// journal. One read transaction lasts as long as the object, so all calls read the same state
  /// of the map, even while Luanti writes to it.
  static Result<LuantiMap, std::string> open(const std::string& file);

  std::uint64_t row_count() const { return row_count_; }

  /// Calls `to_row` for every row, ascending by key. Fails if not all rows could be read.
  Result<void, std::string> each_row(const std::function<void(const LuantiRow&)>& to_row);

  /// Returns the bytes of the first row of a block, or nullopt if the row is missing or cannot be
  /// read. The bytes are valid until the next call. The caller knows from each_row() which rows
  /// exist, so both cases mean damage.
  std::optional<ByteView> find(ChunkCoord block);

 private:
  LuantiMap(sql::Database database, sql::Statement scan, sql::Statement find, bool has_coordinates,
            std::uint64_t row_count)
      : database_(std::move(database)),
        scan_(std::move(scan)),
        find_(std::move(find)),
        has_coordinates_(has_coordinates),
        row_count_(row_count) {}
  LuantiRow row() const;

  sql::Database database_;  // before its statements
  sql::Statement scan_, find_;
  bool has_coordinates_;
  std::uint64_t row_count_;
};

}  // namespace runstone
