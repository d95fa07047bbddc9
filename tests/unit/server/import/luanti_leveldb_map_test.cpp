// Luanti worlds with the backend leveldb: made of the rows of a world with the backend sqlite3, as
// `luantiserver --migrate leveldb` does.
#include <fcntl.h>
#include <leveldb/db.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/import/import_luanti.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/luanti_bytes.hpp"
#include "tests/unit/server/import/luanti_map_file.hpp"

namespace runstone::test {
namespace {

namespace fs = std::filesystem;

const std::string kSqliteWorld = std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/luanti_v7_small";

using Rows = std::vector<std::pair<std::string, std::string>>;

/// Returns the rows of the map of the world with SQLite.
Rows rows_of_sqlite_world() {
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open_v2((kSqliteWorld + "/map.sqlite").c_str(), &db, SQLITE_OPEN_READONLY,
                          nullptr) == SQLITE_OK);
  sqlite3_stmt* rows = nullptr;
  REQUIRE(sqlite3_prepare_v2(db, "SELECT pos, data FROM blocks", -1, &rows, nullptr) == SQLITE_OK);
  Rows out;
  while (sqlite3_step(rows) == SQLITE_ROW) {
    const auto* data = static_cast<const char*>(sqlite3_column_blob(rows, 1));
    out.emplace_back(std::to_string(sqlite3_column_int64(rows, 0)),
                     std::string(data, static_cast<std::size_t>(sqlite3_column_bytes(rows, 1))));
  }
  sqlite3_finalize(rows);
  sqlite3_close(db);
  return out;
}

std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

/// LevelDB's smallest buffer, behind which rows go from the log to a table.
constexpr std::size_t kSmallBuffer = std::size_t{64} << 10;

/// Makes a world whose map has these rows, each written so many times.
void make_leveldb_world(const std::string& folder, const Rows& rows,
                        std::size_t buffer_bytes = std::size_t{4} << 20, int times = 1) {
  fs::create_directories(folder);
  std::ofstream(folder + "/world.mt") << "gameid = minetest\nbackend = leveldb\n";
  leveldb::Options options;
  options.create_if_missing = true;
  options.write_buffer_size = buffer_bytes;
  leveldb::DB* opened = nullptr;
  REQUIRE(leveldb::DB::Open(options, folder + "/map.db", &opened).ok());
  const std::unique_ptr<leveldb::DB> map(opened);
  for (int time = 0; time < times; ++time) {
    for (const auto& [key, data] : rows) REQUIRE(map->Put({}, key, data).ok());
  }
}

/// Moves all rows of the log of a map to tables, and removes tables that are not used any more.
void move_rows_to_tables(const std::string& folder) {
  leveldb::DB* opened = nullptr;
  REQUIRE(leveldb::DB::Open({}, folder, &opened).ok());
  opened->CompactRange(nullptr, nullptr);
  delete opened;
}

/// Returns the bytes of all files of a folder by name.
std::map<std::string, std::string> files_in(const std::string& folder) {
  std::map<std::string, std::string> out;
  for (const auto& entry : fs::directory_iterator(folder)) {
    std::ifstream in(entry.path(), std::ios::binary);
    out[entry.path().filename().string()] = {std::istreambuf_iterator<char>(in), {}};
  }
  return out;
}

std::vector<std::string> tables_in(const std::string& map) {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(map)) {
    if (entry.path().extension() == ".ldb") out.push_back(entry.path().string());
  }
  return out;
}

struct ImportedMap {
  LuantiImportReport report;
  std::map<ChunkKey, RunChunk> chunks;
};

ImportedMap import_map(const std::string& folder) {
  ImportedMap out;
  const LuantiImportSink sink{[](const MaterialTable&) {},
                              [&](const ChunkKey& key, RunChunk&& chunk) {
                                out.chunks.emplace(key, std::move(chunk));
                                return true;
                              },
                              {}};
  auto report = import_luanti(folder, {}, sink);
  INFO((report ? "" : report.error().message()));
  REQUIRE(report.has_value());
  out.report = *std::move(report);
  return out;
}

std::string leveldb_refusal(const std::string& folder) {
  const LuantiImportSink sink{
      [](const MaterialTable&) {}, [](const ChunkKey&, RunChunk&&) { return true; }, {}};
  const auto report = import_luanti(folder, {}, sink);
  return report ? "" : report.error().message();
}

}  // namespace

TEST_CASE("a map in a LevelDB gives the chunks of the same map in SQLite, and stays as it is",
          "[server][import]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  // The rows lie in the log alone, in some tables and the log, and in so many tables that LevelDB
  // wants to compact them when it opens.
  const auto [buffer, times] = GENERATE(
      table<std::size_t, int>({{std::size_t{4} << 20, 1}, {kSmallBuffer, 1}, {kSmallBuffer, 30}}));
  CAPTURE(buffer, times);
  const Rows rows = rows_of_sqlite_world();
  make_leveldb_world(world, rows, buffer, times);
  const auto before = files_in(world + "/map.db");
  const ImportedMap from_leveldb = import_map(world);
  CHECK(files_in(world + "/map.db") == before);

  const ImportedMap from_sqlite = import_map(kSqliteWorld);
  CHECK(from_leveldb.report.blocks == rows.size());
  CHECK(from_leveldb.report.blocks == from_sqlite.report.blocks);
  CHECK(from_leveldb.report.damaged.empty());
  CHECK(from_leveldb.report.repeated.empty());
  CHECK(from_leveldb.report.runs == from_sqlite.report.runs);
  CHECK(from_leveldb.report.materials == from_sqlite.report.materials);
  CHECK(from_leveldb.report.voxels == from_sqlite.report.voxels);
  CHECK(from_leveldb.report.bounds == from_sqlite.report.bounds);
  CHECK(from_leveldb.report.spawn == from_sqlite.report.spawn);
  CHECK(from_leveldb.chunks == from_sqlite.chunks);
  // LevelDB still opens it.
  leveldb::DB* opened = nullptr;
  REQUIRE(leveldb::DB::Open({}, world + "/map.db", &opened).ok());
  delete opened;
}

TEST_CASE("keys of a LevelDB that are no position of a block are damage", "[server][import]") {
  const TempFolder folder;
  const std::string stone = text_of(luanti_row(stone_block()));
  make_leveldb_world(folder / "world", {{"0", stone},
                                        {"1", "\x16"},
                                        {"00", stone},
                                        {"+1", stone},
                                        {"x", stone},
                                        {"", stone},
                                        {"99999999999999999999", stone},
                                        {"-17592186044417", stone}});
  const ImportedMap map = import_map(folder / "world");
  CHECK(map.report.blocks == 1);
  CHECK(map.report.damaged.size() == 7);
}

TEST_CASE("a damaged LevelDB is refused in one line", "[server][import]") {
  const TempFolder folder;
  const std::string world = folder / "world";
  make_leveldb_world(world, rows_of_sqlite_world());
  move_rows_to_tables(world + "/map.db");
  const std::vector<std::string> tables = tables_in(world + "/map.db");
  REQUIRE_FALSE(tables.empty());
  const std::string& table = tables.front();
  std::string expected = "map.db: damaged: ";
  SECTION("a flipped byte in a table") {
    std::fstream file(table, std::ios::binary | std::ios::in | std::ios::out);
    file.seekg(1000);
    const char byte = static_cast<char>(file.get() ^ 1);
    file.seekp(1000);
    file.put(byte);
  }
  SECTION("a table that is missing") { fs::remove(table); }
  SECTION("a table that is cut short") { fs::resize_file(table, fs::file_size(table) / 2); }
  SECTION("a table that is a pipe") {
    fs::remove(table);
    REQUIRE(::mkfifo(table.c_str(), 0600) == 0);
    expected = "map.db: cannot be read: ";
  }
  SECTION("a damaged manifest") {
    for (const auto& entry : fs::directory_iterator(world + "/map.db")) {
      if (entry.path().filename().string().starts_with("MANIFEST"))
        std::ofstream(entry.path(), std::ios::binary) << std::string(100, '\x07');
    }
  }
  SECTION("no file CURRENT") {
    fs::remove(world + "/map.db/CURRENT");
    expected = "map.db: not a LevelDB, or not all of its files are there: it has no file CURRENT";
  }
  const std::string words = leveldb_refusal(world);
  CAPTURE(words);
  CHECK(words.find(expected) != std::string::npos);
  CHECK(words.find('\n') == std::string::npos);
}

TEST_CASE("a LevelDB of a server that runs is refused", "[server][import]") {
  const TempFolder folder;
  const std::string world = folder / "world", lock = world + "/map.db/LOCK";
  make_leveldb_world(world, {{"0", text_of(luanti_row(stone_block()))}});
  int ready[2], done[2];
  REQUIRE(::pipe(ready) == 0);
  REQUIRE(::pipe(done) == 0);
  const pid_t child = ::fork();
  if (child == 0) {
    // As LevelDB locks it.
    struct flock held{};
    held.l_type = F_WRLCK;
    held.l_whence = SEEK_SET;
    const int file = ::open(lock.c_str(), O_RDWR);
    char byte = ::fcntl(file, F_SETLK, &held) == 0 ? 'y' : 'n';
    if (::write(ready[1], &byte, 1) != 1) ::_exit(1);
    ::close(done[1]);
    static_cast<void>(!::read(done[0], &byte, 1));
    ::_exit(0);
  }
  char is_held = 'n';
  REQUIRE(::read(ready[0], &is_held, 1) == 1);
  CHECK(is_held == 'y');
  const std::string words = leveldb_refusal(world);
  for (const int end : {ready[0], ready[1], done[0], done[1]}) ::close(end);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CAPTURE(words);
  CHECK(words.find("map.db: in use: another program holds its lock. Stop the Luanti server") !=
        std::string::npos);
  CHECK(import_map(world).report.blocks == 1);
}

TEST_CASE("a LevelDB without blocks, and a world without one, are refused", "[server][import]") {
  const TempFolder folder;
  make_leveldb_world(folder / "world", {});
  CHECK(leveldb_refusal(folder / "world").find("map.db: has no blocks") != std::string::npos);
  fs::remove_all(folder / "world/map.db");
  CHECK(leveldb_refusal(folder / "world").find("map.db: does not exist") != std::string::npos);
}

}  // namespace runstone::test
