#include "server/import/luanti_map.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/formats/luanti_block.hpp"
#include "common/sql/database.hpp"
#include "common/sqlite/sqlite_file.hpp"

namespace runstone {
namespace {

struct Layout {
  const char *scan, *find;
  bool has_coordinates;
};

// Either both statements of a layout can be prepared, or none. The order of the rows decides which
// row of a position is the first one; a table without row numbers has one row of each.
constexpr std::array kLayouts = {
    Layout{"SELECT pos, data FROM blocks ORDER BY pos, rowid",
           "SELECT data FROM blocks WHERE pos = ?1 ORDER BY rowid LIMIT 1", false},
    Layout{"SELECT pos, data FROM blocks ORDER BY pos", "SELECT data FROM blocks WHERE pos = ?1",
           false},
    // Of Luanti 5.12 and later.
    Layout{"SELECT x, y, z, data FROM blocks ORDER BY z, y, x, rowid",
           "SELECT data FROM blocks WHERE x = ?1 AND y = ?2 AND z = ?3 ORDER BY rowid LIMIT 1",
           true},
    Layout{"SELECT x, y, z, data FROM blocks ORDER BY z, y, x",
           "SELECT data FROM blocks WHERE x = ?1 AND y = ?2 AND z = ?3", true},
};

constexpr std::int64_t kBlockLimit = 2048;  // coordinates are -2048 .. 2047

bool has_bytes(const std::string& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  return !error && bytes > 0;
}

/// Returns one line on why a map cannot be read, and what to do.
std::string words_of(const std::string& file, const sql::Error& error) {
  switch (error.kind) {
    case sql::Error::Kind::bad_statement:
      return "not a Luanti map: " + error.what;
    case sql::Error::Kind::corrupt:
      return "damaged, or not an SQLite file: " + error.what +
             ". Restore it from a backup, or see what \"sqlite3 map.sqlite .recover\" saves of a "
             "copy";
    case sql::Error::Kind::locked:
      return "in use: another program is writing to it (" + error.what +
             "). Stop the Luanti server, or copy the folder of the world while the server is "
             "stopped, and import the copy";
    default:
      break;
  }
  // A journal with bytes belongs to a save that did not end. Only a writer may roll it back.
  if (has_bytes(file + "-journal") || has_bytes(file + "-wal")) {
    return "has the journal of a save that did not end (" + error.what +
           "), and an import changes nothing in the folder. If a Luanti server runs, stop it. If "
           "it crashed, copy the folder with all its files, start Luanti once with the copy, and "
           "import the copy";
  }
  return "cannot be read: " + error.what +
         ". If the folder is read-only, copy it and import the copy";
}

/// One read transaction lasts as long as the object, so all calls read the same state of the map,
/// even while Luanti writes to it.
class SqliteMap final : public LuantiMap {
 public:
  SqliteMap(sql::Database database, sql::Statement scan, sql::Statement find, bool has_coordinates,
            std::uint64_t row_count)
      : database_(std::move(database)),
        scan_(std::move(scan)),
        find_(std::move(find)),
        has_coordinates_(has_coordinates),
        row_count_(row_count) {}

  std::uint64_t row_count() const override { return row_count_; }
  Result<void, std::string> each_row(const std::function<void(const LuantiRow&)>& to_row) override;
  std::optional<ByteView> find(ChunkCoord block) override;

 private:
  LuantiRow row() const;

  sql::Database database_;  // before its statements
  sql::Statement scan_, find_;
  bool has_coordinates_;
  std::uint64_t row_count_;
};

LuantiRow SqliteMap::row() const {
  LuantiRow out;
  if (!has_coordinates_) {
    out.pos = scan_.integer(0);
    out.block = luanti_block_coord(out.pos);
    out.is_placed = scan_.type(0) == sql::Type::integer && luanti_block_pos(out.block) == out.pos;
    out.data = scan_.blob(1);
    return out;
  }
  out.is_placed = true;
  const auto coordinate = [&](int column) {
    const std::int64_t value = scan_.integer(column);
    out.is_placed = out.is_placed && scan_.type(column) == sql::Type::integer &&
                    value >= -kBlockLimit && value < kBlockLimit;
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(value, std::int64_t{INT32_MIN}, std::int64_t{INT32_MAX}));
  };
  out.block = {coordinate(0), coordinate(1), coordinate(2)};
  out.pos = luanti_block_pos(out.block);
  out.data = scan_.blob(3);
  return out;
}

Result<void, std::string> SqliteMap::each_row(
    const std::function<void(const LuantiRow& row)>& to_row) {
  scan_.rewind();
  for (;;) {
    const auto more = scan_.step();
    if (!more) return failure(words_of(database_.file(), more.error()));
    if (!*more) return {};
    to_row(row());
  }
}

std::optional<ByteView> SqliteMap::find(ChunkCoord block) {
  find_.rewind();
  if (has_coordinates_) {
    find_.bind(1, std::int64_t{block.x})
        .bind(2, std::int64_t{block.y})
        .bind(3, std::int64_t{block.z});
  } else {
    find_.bind(1, luanti_block_pos(block));
  }
  const auto found = find_.step();
  if (!found || !*found) return std::nullopt;
  return find_.blob(0);
}

}  // namespace

Result<std::unique_ptr<LuantiMap>, std::string> open_luanti_sqlite_map(const std::string& file) {
  const auto no_map = [&](const sql::Error& error) { return failure(words_of(file, error)); };
  auto database = sql::open_sqlite(file, sql::SqliteMode::read);
  if (!database) return no_map(database.error());
  // The transaction ends with the connection.
  if (const auto begun = database->run("BEGIN"); !begun) return no_map(begun.error());
  const auto count = database->integer("SELECT count(*) FROM blocks");
  if (!count) return no_map(count.error());
  std::string why;
  for (const Layout& layout : kLayouts) {
    auto scan = database->prepare(layout.scan);
    auto find = database->prepare(layout.find);
    if (scan && find) {
      return std::unique_ptr<LuantiMap>(
          std::make_unique<SqliteMap>(*std::move(database), *std::move(scan), *std::move(find),
                                      layout.has_coordinates, static_cast<std::uint64_t>(*count)));
    }
    why = words_of(file, scan ? find.error() : scan.error());
  }
  return failure(why);
}

}  // namespace runstone
