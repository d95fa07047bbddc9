#include "server/import/luanti_map.hpp"

#include "common/formats/luanti_block.hpp"
#include "common/sqlite/sqlite_file.hpp"

namespace runstone {
namespace {

constexpr const char* kScan = "SELECT pos, data FROM blocks ORDER BY pos";
constexpr const char* kFind = "SELECT data FROM blocks WHERE pos = ?1";
// The statements of the layout of Luanti 5.12. Either both statements of a layout can be prepared,
// or none.
constexpr const char* kScanByCoordinates =
    "SELECT (z * 4096 + y) * 4096 + x AS pos, data FROM blocks ORDER BY z, y, x";
constexpr const char* kFindByCoordinates =
    "SELECT data FROM blocks WHERE x = ?1 AND y = ?2 AND z = ?3";

}  // namespace

Result<LuantiMap, std::string> LuantiMap::open(const std::string& file) {
  auto database = sql::open_sqlite(file, sql::SqliteMode::read);
  if (!database) return failure(database.error().what);
  // The transaction ends with the connection.
  if (const auto begun = database->run("BEGIN"); !begun) return failure(begun.error().what);
  const auto no_map = [](const sql::Error& error) {
    return failure("not a Luanti map: " + error.what);
  };
  const auto count = database->integer("SELECT count(*) FROM blocks");
  if (!count) return no_map(count.error());
  auto scan = database->prepare(kScan);
  auto find = database->prepare(kFind);
  if (!scan) {
    scan = database->prepare(kScanByCoordinates);
    find = database->prepare(kFindByCoordinates);
  }
  if (!scan) return no_map(scan.error());
  if (!find) return no_map(find.error());
  return LuantiMap(*std::move(database), *std::move(scan), *std::move(find),
                   static_cast<std::uint64_t>(*count));
}

Result<void, std::string> LuantiMap::each_row(
    const std::function<void(std::int64_t pos, ByteView data)>& row) {
  scan_.rewind();
  for (;;) {
    const auto more = scan_.step();
    if (!more) return failure(more.error().what);
    if (!*more) return {};
    row(scan_.integer(0), scan_.blob(1));
  }
}

std::optional<ByteView> LuantiMap::find(std::int64_t pos) {
  find_.rewind();
  if (find_.parameter_count() == 1) {
    find_.bind(1, pos);
  } else {
    const ChunkCoord block = luanti_block_coord(pos);
    find_.bind(1, std::int64_t{block.x})
        .bind(2, std::int64_t{block.y})
        .bind(3, std::int64_t{block.z});
  }
  const auto found = find_.step();
  if (!found || !*found) return std::nullopt;
  return find_.blob(0);
}

}  // namespace runstone
