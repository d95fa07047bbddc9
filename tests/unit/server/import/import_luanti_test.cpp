// The import of a whole Luanti world against an independent reader of every node.
#include "server/import/import_luanti.hpp"

#include <sqlite3.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "common/formats/luanti_block.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/luanti_bytes.hpp"
#include "tests/support/sql/raw_sql.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

const std::string kWorld = std::string(RUNSTONE_SOURCE_DIR) + "/tests/data/luanti_v7_small";

/// Calls f(block, name of every node, with its param2 if that is not 0) for each row of a map,
/// without any code of the importer.
void each_block(const std::string& folder,
                const std::function<void(ChunkCoord, const std::vector<std::string>&)>& f) {
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open_v2((folder + "/map.sqlite").c_str(), &db, SQLITE_OPEN_READONLY, nullptr) ==
          SQLITE_OK);
  sqlite3_stmt* rows = nullptr;
  REQUIRE(sqlite3_prepare_v2(db, "SELECT pos, data FROM blocks", -1, &rows, nullptr) == SQLITE_OK);
  while (sqlite3_step(rows) == SQLITE_ROW) {
    // pos = z * 4096^2 + y * 4096 + x with -2048 <= x, y, z < 2048, solved by shifting all three to
    // be positive.
    const std::int64_t shifted =
        sqlite3_column_int64(rows, 0) + 2048 * (std::int64_t{1} + 4096 + 4096 * 4096);
    const ChunkCoord at{static_cast<std::int32_t>(shifted % 4096 - 2048),
                        static_cast<std::int32_t>(shifted / 4096 % 4096 - 2048),
                        static_cast<std::int32_t>(shifted / 4096 / 4096 - 2048)};
    const auto* data = static_cast<const std::uint8_t*>(sqlite3_column_blob(rows, 1));
    const ByteView row{data, static_cast<std::size_t>(sqlite3_column_bytes(rows, 1))};
    std::vector<std::string> nodes = luanti_nodes(row);
    const Bytes params = luanti_params(row);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (params[i] != 0 && nodes[i] != "air")
        nodes[i] += "[param2=" + std::to_string(params[i]) + "]";
    }
    f(at, nodes);
  }
  sqlite3_finalize(rows);
  sqlite3_close(db);
}

struct Imported {
  LuantiImportReport report;
  std::map<ChunkKey, RunChunk> chunks;
  std::int32_t edge = 0;

  Material at(VoxelPos pos) const {
    const auto found = chunks.find({0, chunk_of(pos, edge)});
    return found == chunks.end() ? kEmpty : material_at(found->second, local_of(pos, edge));
  }
};

Imported import(const std::string& folder, std::int32_t edge, bool keep_all = false) {
  Imported out;
  out.edge = edge;
  int tables = 0;
  std::uint64_t last_done = 0, last_total = 0;
  const LuantiImportSink sink{
      [&](const MaterialTable& table) {
        ++tables;
        CHECK(out.chunks.empty());
        CHECK(table.size() > 1);
      },
      [&](const ChunkKey& key, RunChunk&& chunk) {
        REQUIRE(validate(chunk).has_value());
        REQUIRE(chunk.extent == Extent::cube(static_cast<unsigned>(edge)));
        CHECK_FALSE((chunk.is_uniform() && chunk.runs.material(0) == kEmpty));
        REQUIRE(out.chunks.emplace(key, std::move(chunk)).second);
        return true;
      },
      [&](std::uint64_t done, std::uint64_t total) {
        CHECK(done >= last_done);
        CHECK(done <= total);
        last_done = done;
        last_total = total;
      }};
  auto report = import_luanti(folder, {edge, keep_all}, sink);
  REQUIRE(report.has_value());
  CHECK(tables == 1);
  CHECK(last_done == last_total);
  CHECK(last_done > 0);
  out.report = std::move(report).value();
  CHECK(out.report.chunks == out.chunks.size());
  return out;
}

/// Returns the number of nodes with a wrong voxel. `skip` names blocks that must have become empty.
std::uint64_t wrong_voxels(const Imported& world, const std::string& folder,
                           const std::function<bool(ChunkCoord)>& skip = {}) {
  const MaterialTable& table = world.report.materials;
  std::uint64_t wrong = 0;
  std::map<std::string, Material> ids;
  const auto expected = [&](const std::string& name) {
    const auto known = ids.find(name);
    if (known != ids.end()) return known->second;
    const bool there = name != "air" && name != "ignore";
    const auto row = table.find(name);
    const Material id = there ? row.value_or(0xffff) : kEmpty;
    if (!there && name != "air") wrong += static_cast<std::uint64_t>(row.has_value());
    return ids.emplace(name, id).first->second;
  };
  each_block(folder, [&](ChunkCoord block, const std::vector<std::string>& nodes) {
    const bool emptied = skip && skip(block);
    const VoxelPos origin = origin_of(block, 16);
    for (std::int32_t i = 0; i < 4096; ++i) {
      const VoxelPos pos{origin.x + i % 16, origin.y + i / 16 % 16, origin.z + i / 256};
      const Material want = emptied ? kEmpty : expected(nodes[static_cast<std::size_t>(i)]);
      wrong += static_cast<std::uint64_t>(world.at(pos) != want);
    }
  });
  return wrong;
}

void copy_world(const TempFolder& folder) {
  std::filesystem::copy_file(kWorld + "/map.sqlite", folder / "map.sqlite");
  std::filesystem::permissions(folder / "map.sqlite", std::filesystem::perms::owner_all);
}

}  // namespace

TEST_CASE("every voxel of an imported world is its node", "[server][import]") {
  const std::int32_t edge = GENERATE(16, 32, 64, 128);
  const Imported world = import(kWorld, edge);
  CAPTURE(edge);
  CHECK(world.report.blocks == 384);
  CHECK(world.report.damaged.empty());
  CHECK(world.report.bounds == VoxelBox{{-64, -32, -64}, {64, 64, 64}});
  CHECK(wrong_voxels(world, kWorld) == 0);

  std::uint64_t solid = 0;
  for (std::size_t id = 1; id < world.report.voxels.size(); ++id) solid += world.report.voxels[id];
  CHECK(solid == 693570);
  CHECK(world.report.voxels[0] ==
        world.chunks.size() * static_cast<std::uint64_t>(edge * edge * edge) - solid);
}

TEST_CASE("the param2 of nodes makes few materials", "[server][import]") {
  const Imported world = import(kWorld, 32);
  const MaterialTable& table = world.report.materials;
  std::map<std::string, std::uint64_t> found;
  for (std::size_t id = 0; id < table.size(); ++id) {
    const std::string& name = table[static_cast<Material>(id)].name;
    if (name.find('[') != std::string::npos) found[name] = world.report.voxels[id];
  }
  CHECK(found == std::map<std::string, std::uint64_t>{{"default:acacia_tree[param2=1]", 26},
                                                      {"default:acacia_tree[param2=2]", 26},
                                                      {"default:acacia_tree[param2=3]", 25},
                                                      {"default:chest[param2=2]", 2},
                                                      {"stairs:stair_cobble[param2=3]", 20}});
  const LuantiImportSink sink{
      [](const MaterialTable&) {}, [](const ChunkKey&, RunChunk&&) { return true; }, {}};
  const auto without = import_luanti(kWorld, {.edge = 32, .only_cubes = true}, sink);
  REQUIRE(without.has_value());
  // Plants are materials of the world alone.
  std::size_t shapes = 0;
  for (const MaterialInfo& row : table.rows()) shapes += row.shape.is_cube() ? 0 : 1;
  CHECK(shapes > 10);
  CHECK(without->materials.size() < table.size() - 4);
  for (const MaterialInfo& row : without->materials.rows()) {
    CHECK(row.shape.is_cube());
    CHECK(row.name.find('[') == std::string::npos);
  }
}

TEST_CASE("plants are imported with their shapes", "[server][import]") {
  const Imported world = import(kWorld, 32);
  CHECK(wrong_voxels(world, kWorld) == 0);
  const auto tulip = world.report.materials.find("flowers:tulip");
  REQUIRE(tulip.has_value());
  CHECK(world.report.voxels[*tulip] == 6);
  CHECK_FALSE(world.report.materials[*tulip].shape.is_cube());
  CHECK(import(kWorld, 32, true).report.materials == world.report.materials);
}

TEST_CASE("the node check detects one wrong voxel", "[server][import]") {
  Imported world = import(kWorld, 32);
  RunChunk& chunk = world.chunks.begin()->second;
  REQUIRE(fill(chunk, 1234, 1, chunk.runs.material(find_run(chunk, 1234)) == 1 ? 2 : 1));
  CHECK(wrong_voxels(world, kWorld) == 1);
}

TEST_CASE("materials are numbered by name, whatever the edge", "[server][import]") {
  const Imported a = import(kWorld, 16), b = import(kWorld, 64);
  CHECK(a.report.materials == b.report.materials);
  CHECK(a.report.spawn == b.report.spawn);
  const auto rows = a.report.materials.rows();
  for (std::size_t i = 2; i < rows.size(); ++i) CHECK(rows[i - 1].name < rows[i].name);
  for (std::size_t i = 1; i < rows.size(); ++i) CHECK(rows[i].visibility != Visibility::empty);
}

TEST_CASE("the spawn is on top of the middle of an imported world", "[server][import]") {
  const Imported world = import(kWorld, 32);
  const VoxelPos spawn = world.report.spawn;
  CHECK(spawn.x == 0);
  CHECK(spawn.z == 0);
  CHECK(world.at({0, spawn.y - 1, 0}) != kEmpty);
  for (std::int32_t y = spawn.y; y < 64; ++y) CHECK(world.at({0, y, 0}) == kEmpty);
}

TEST_CASE("damaged blocks are listed and left empty, and the rest is whole", "[server][import]") {
  const TempFolder folder;
  copy_world(folder);
  const ChunkCoord cut{0, 0, 0}, later{-4, -2, -4}, noise{3, 1, 2};
  const auto where = [](ChunkCoord at) {
    return " WHERE pos = " + std::to_string(luanti_block_pos(at));
  };
  raw_sql(folder / "map.sqlite",
          "UPDATE blocks SET data = substr(data, 1, length(data) - 1)" + where(cut));
  raw_sql(folder / "map.sqlite",
          "UPDATE blocks SET data = x'1e' || substr(data, 2)" + where(later));
  raw_sql(folder / "map.sqlite",
          "UPDATE blocks SET data = x'1d00112233445566778899'" + where(noise));
  raw_sql(folder / "map.sqlite", "INSERT INTO blocks VALUES ((1 << 40) + 1, x'1d')");

  const Imported world = import(folder.path(), 32);
  CHECK(world.report.blocks == 381);
  std::map<ChunkCoord, ErrorCode> damaged;
  for (const DamagedBlock& block : world.report.damaged) damaged[block.block] = block.error.code;
  REQUIRE(world.report.damaged.size() == 4);
  CHECK(damaged.at(cut) == ErrorCode::truncated);
  CHECK(damaged.at(later) == ErrorCode::bad_version);
  CHECK(damaged.at(noise) == ErrorCode::bad_value);
  CHECK(world.report.damaged.back().pos == (std::int64_t{1} << 40) + 1);

  const auto is_damaged = [&](ChunkCoord at) { return at == cut || at == later || at == noise; };
  CHECK(wrong_voxels(world, kWorld, is_damaged) == 0);
}

TEST_CASE("a map with columns x, y and z imports like one with pos", "[server][import]") {
  const TempFolder folder;
  copy_world(folder);
  REQUIRE(raw_sql(folder / "map.sqlite",
                  "ALTER TABLE blocks RENAME TO old; CREATE TABLE blocks(x INT, y INT, z INT, "
                  "data BLOB NOT NULL, PRIMARY KEY(x, z, y))") == "");
  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open((folder / "map.sqlite").c_str(), &db) == SQLITE_OK);
  sqlite3_exec(db, "BEGIN", nullptr, nullptr, nullptr);
  for (std::int32_t i = 0; i < 8 * 6 * 8; ++i) {
    const ChunkCoord at{i % 8 - 4, i / 8 % 6 - 2, i / 48 - 4};
    const std::string row =
        std::to_string(at.x) + "," + std::to_string(at.y) + "," + std::to_string(at.z);
    const std::string sql = "INSERT INTO blocks SELECT " + row +
                            ", data FROM old WHERE pos = " + std::to_string(luanti_block_pos(at));
    REQUIRE(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr) == SQLITE_OK);
  }
  sqlite3_exec(db, "COMMIT", nullptr, nullptr, nullptr);
  sqlite3_close(db);
  const Imported a = import(kWorld, 32), b = import(folder.path(), 32);
  CHECK(a.report.blocks == b.report.blocks);
  CHECK(a.chunks == b.chunks);
}

TEST_CASE("a file that is no map is refused, and the error names it", "[server][import]") {
  const TempFolder folder;
  const LuantiImportSink sink{
      [](const MaterialTable&) {}, [](const ChunkKey&, RunChunk&&) { return true; }, {}};
  const auto missing = import_luanti(folder / "nowhere", {}, sink);
  REQUIRE_FALSE(missing.has_value());
  CHECK(missing.error().message().find("nowhere: does not exist") != std::string::npos);

  sqlite3* db = nullptr;
  REQUIRE(sqlite3_open((folder / "map.sqlite").c_str(), &db) == SQLITE_OK);
  REQUIRE(sqlite3_exec(db, "CREATE TABLE cheese(a)", nullptr, nullptr, nullptr) == SQLITE_OK);
  sqlite3_close(db);
  const auto other = import_luanti(folder.path(), {}, sink);
  REQUIRE_FALSE(other.has_value());
  CHECK(other.error().what.find("not a Luanti map") != std::string::npos);
}

TEST_CASE("a sink that returns false ends the import", "[server][import]") {
  int chunks = 0;
  const LuantiImportSink sink{
      [](const MaterialTable&) {}, [&](const ChunkKey&, RunChunk&&) { return ++chunks < 3; }, {}};
  const auto report = import_luanti(kWorld, {}, sink);
  REQUIRE_FALSE(report.has_value());
  CHECK(report.error().what == "the import was stopped");
  CHECK(chunks == 3);
}
