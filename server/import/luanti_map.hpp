// LuantiMap: the rows of the map of a Luanti world, for reading only: one for each block of 16^3
// nodes. The setting `backend` of the world decides what keeps them:
//   - sqlite3: map.sqlite, whose one table has two layouts: blocks(pos, data), and since Luanti 5.12
//     blocks(x, y, z, data);
//   - leveldb: the folder map.db, whose keys are the decimal digits of pos.
// All calls read the same state of the map. Threads: any, one at a time. It blocks on the disk.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "server/import/luanti_folder.hpp"

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
  virtual ~LuantiMap() = default;

  virtual std::uint64_t row_count() const = 0;

  /// Calls `to_row` for every row, in the order of the keys. Rows of one position come one after
  /// another. Fails if not all rows could be read.
  virtual Result<void, std::string> each_row(
      const std::function<void(const LuantiRow&)>& to_row) = 0;

  /// Returns the bytes of the first row of a block, or nullopt if the row is missing or cannot be
  /// read. The bytes are valid until the next call. The caller knows from each_row() which rows
  /// exist, so both cases mean damage.
  virtual std::optional<ByteView> find(ChunkCoord block) = 0;
};

/// Opens a map. The error is one line of text, and says what to do if the map is in use, is damaged
/// or has a journal.
Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_map(const LuantiFolder& folder);
Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_sqlite_map(const std::string& file);
Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_leveldb_map(const std::string& folder);

}  // namespace runstone
