// Maps as hosts have them: written by other versions, by other programs, or while a server runs.
#include "server/import/luanti_map.hpp"

#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "common/formats/luanti_block.hpp"
#include "server/import/import_luanti.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/luanti_bytes.hpp"
#include "tests/support/sql/raw_sql.hpp"
#include "tests/unit/server/import/luanti_map_file.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

Result<LuantiImportReport, ImportError> map_of(const std::string& folder) {
  const LuantiImportSink sink{
      [](const MaterialTable&) {}, [](const ChunkKey&, RunChunk&&) { return true; }, {}};
  return import_luanti(folder, {}, sink);
}

std::string map_refusal(const std::string& folder) {
  const auto report = map_of(folder);
  return report ? "" : report.error().message();
}

}  // namespace

TEST_CASE("blocks of the versions 24 to 28 are imported beside those of version 29",
          "[server][import]") {
  const TempFolder folder;
  std::vector<LuantiMapRow> rows = {{{0, 0, 0}, luanti_row(stone_block())}};
  for (std::uint8_t version = 24; version <= 28; ++version)
    rows.push_back({{version, 0, 0}, luanti_old_row(stone_block(), version)});
  write_luanti_map(folder / "map.sqlite", rows);
  const auto report = map_of(folder.path());
  REQUIRE(report.has_value());
  CHECK(report->blocks == 6);
  CHECK(report->damaged.empty());
  REQUIRE(report->materials.find("default:stone").has_value());
  CHECK(report->voxels[*report->materials.find("default:stone")] == 6 * 4096);
}

TEST_CASE("a damaged block is listed with its version", "[server][import]") {
  const TempFolder folder;
  Bytes cut = luanti_old_row(stone_block(), 25);
  cut.resize(cut.size() - 20);
  write_luanti_map(folder / "map.sqlite", {{{0, 0, 0}, luanti_row(stone_block())},
                                           {{1, 0, 0}, cut},
                                           {{2, 0, 0}, Bytes{22, 0}},
                                           {{3, 0, 0}, Bytes{}}});
  const auto report = map_of(folder.path());
  REQUIRE(report.has_value());
  CHECK(report->blocks == 1);
  REQUIRE(report->damaged.size() == 3);
  CHECK(report->damaged[0].version == 25);
  CHECK(report->damaged[1].version == 22);
  CHECK(report->damaged[1].error.code == ErrorCode::bad_version);
  CHECK_FALSE(report->damaged[2].version.has_value());
}

TEST_CASE("a map without blocks is refused", "[server][import]") {
  const TempFolder folder;
  write_luanti_map(folder / "map.sqlite", {});
  CHECK(map_refusal(folder.path()).find("map.sqlite: has no blocks") != std::string::npos);
}

TEST_CASE("of rows with one position the first is imported, and the others are reported",
          "[server][import]") {
  const TempFolder folder;
  LuantiBlockFields dirt = stone_block();
  dirt.names[0].second = "default:dirt";
  write_luanti_map(folder / "map.sqlite",
                   {{{0, 0, 0}, luanti_row(stone_block())},
                    {{1, 0, 0}, luanti_row(stone_block())},
                    {{0, 0, 0}, luanti_row(dirt)}},
                   "CREATE TABLE blocks (pos INT, data BLOB)");
  std::uint64_t done_last = 0, total_last = 0;
  const LuantiImportSink sink{[](const MaterialTable&) {},
                              [](const ChunkKey&, RunChunk&&) { return true; },
                              [&](std::uint64_t done, std::uint64_t total) {
                                done_last = done;
                                total_last = total;
                              }};
  const auto report = import_luanti(folder.path(), {}, sink);
  REQUIRE(report.has_value());
  CHECK(report->blocks == 2);
  CHECK(report->repeated == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK_FALSE(report->materials.find("default:dirt").has_value());
  CHECK(done_last == total_last);
}

TEST_CASE("keys that are no position of a block are damage, in both layouts", "[server][import]") {
  const TempFolder folder;
  const std::string file = folder / "map.sqlite";
  SECTION("a key of text") {
    write_luanti_map(file, {{{0, 0, 0}, luanti_row(stone_block())}},
                     "CREATE TABLE blocks (pos, data)");
    raw_sql(file, "INSERT INTO blocks SELECT 'abc', data FROM blocks");
  }
  SECTION("a coordinate beyond the map, which the sum of the key would fold into it") {
    write_luanti_map(file, {});
    const std::string row = hex_row(luanti_row(stone_block()));
    raw_sql(file, "DROP TABLE blocks; CREATE TABLE blocks (x INT, y INT, z INT, data BLOB)");
    raw_sql(file, "INSERT INTO blocks VALUES (0, 0, 0, " + row + "), (5000, 0, 0, " + row + ")");
  }
  const auto report = map_of(folder.path());
  REQUIRE(report.has_value());
  CHECK(report->blocks == 1);
  REQUIRE(report->damaged.size() == 1);
  CHECK(report->damaged[0].error.what == std::string("luanti block: not a block position"));
}

TEST_CASE("a map with the journal of a save that did not end says what to do", "[server][import]") {
  const TempFolder folder;
  const std::string file = folder / "map.sqlite";
  std::vector<LuantiMapRow> rows;
  for (std::int32_t x = 0; x < 2000; ++x) rows.push_back({{x, 0, 0}, luanti_row(stone_block())});
  write_luanti_map(file, rows);
  const pid_t child = ::fork();
  if (child == 0) {
    sqlite3* db = nullptr;
    sqlite3_open(file.c_str(), &db);
    sqlite3_exec(db, "PRAGMA cache_size = 5; BEGIN; UPDATE blocks SET data = zeroblob(300)",
                 nullptr, nullptr, nullptr);
    ::_exit(0);  // in the middle of the save
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  const std::string words = map_refusal(folder.path());
  CAPTURE(words);
  CHECK(words.find("map.sqlite: has the journal of a save that did not end") != std::string::npos);
  CHECK(words.find("copy the folder") != std::string::npos);
}

TEST_CASE("a map to which another program writes says so", "[server][import]") {
  const TempFolder folder;
  const std::string file = folder / "map.sqlite";
  write_luanti_map(file, {{{0, 0, 0}, luanti_row(stone_block())}});
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open(file.c_str(), &db) == SQLITE_OK);
  REQUIRE(sqlite3_exec(db, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr) == SQLITE_OK);
  const std::string words = map_refusal(folder.path());
  sqlite3_close(db);
  CAPTURE(words);
  CHECK(words.find("map.sqlite: in use") != std::string::npos);
  CHECK(words.find("Stop the Luanti server, or copy") != std::string::npos);
}
