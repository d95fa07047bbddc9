#include "server/import/luanti_map.hpp"

#include "common/formats/luanti_block.hpp"

namespace runstone {
namespace {

ByteView blob_of(sqlite3_stmt* statement, int column) {
  // The blob first: asking for its size afterwards is the order that SQLite documents as safe.
  const void* data = sqlite3_column_blob(statement, column);
  const int size = sqlite3_column_bytes(statement, column);
  return {static_cast<const std::uint8_t*>(data),
          data == nullptr ? 0 : static_cast<std::size_t>(size)};
}

}  // namespace

LuantiMap::Statement LuantiMap::prepare(const std::string& sql) {
  sqlite3_stmt* statement = nullptr;
  sqlite3_prepare_v2(db_.get(), sql.c_str(), -1, &statement, nullptr);
  return Statement(statement);
}

Result<LuantiMap, std::string> LuantiMap::open(const std::string& file) {
  LuantiMap map;
  sqlite3* db = nullptr;
  const int opened = sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READONLY, nullptr);
  map.db_.reset(db);
  if (opened != SQLITE_OK) {
    return Unexpected<std::string>{db == nullptr ? "out of memory" : map.trouble()};
  }
  sqlite3_busy_timeout(db, 5000);
  // One read transaction for both passes; it ends with the connection.
  if (sqlite3_exec(db, "BEGIN", nullptr, nullptr, nullptr) != SQLITE_OK) {
    return Unexpected<std::string>{map.trouble()};
  }
  const Statement count = map.prepare("SELECT count(*) FROM blocks");
  if (count == nullptr || sqlite3_step(count.get()) != SQLITE_ROW) {
    return Unexpected<std::string>{"not a Luanti map: " + map.trouble()};
  }
  map.row_count_ = static_cast<std::uint64_t>(sqlite3_column_int64(count.get(), 0));
  map.scan_ = map.prepare("SELECT pos, data FROM blocks ORDER BY pos");
  if (map.scan_ != nullptr) {
    map.find_ = map.prepare("SELECT data FROM blocks WHERE pos = ?1");
  } else {
    map.scan_ =
        map.prepare("SELECT (z * 4096 + y) * 4096 + x AS pos, data FROM blocks ORDER BY z, y, x");
    map.find_ = map.prepare("SELECT data FROM blocks WHERE x = ?2 AND y = ?3 AND z = ?4");
  }
  if (map.scan_ == nullptr || map.find_ == nullptr) {
    return Unexpected<std::string>{"not a Luanti map: " + map.trouble()};
  }
  return map;
}

std::optional<std::string> LuantiMap::each_row(
    const std::function<void(std::int64_t pos, ByteView data)>& row) {
  sqlite3_reset(scan_.get());
  while (true) {
    const int status = sqlite3_step(scan_.get());
    if (status == SQLITE_DONE) return std::nullopt;
    if (status != SQLITE_ROW) return trouble();
    row(sqlite3_column_int64(scan_.get(), 0), blob_of(scan_.get(), 1));
  }
}

std::optional<ByteView> LuantiMap::find(std::int64_t pos) {
  sqlite3_reset(find_.get());
  const ChunkCoord block = luanti_block_coord(pos);
  if (sqlite3_bind_parameter_count(find_.get()) == 1) {
    sqlite3_bind_int64(find_.get(), 1, pos);
  } else {
    sqlite3_bind_int(find_.get(), 2, block.x);
    sqlite3_bind_int(find_.get(), 3, block.y);
    sqlite3_bind_int(find_.get(), 4, block.z);
  }
  if (sqlite3_step(find_.get()) != SQLITE_ROW) return std::nullopt;
  return blob_of(find_.get(), 0);
}

}  // namespace runstone
