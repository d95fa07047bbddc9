// Files with a build become worlds, and boxes of worlds become files.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>

#include "common/formats/file_build.hpp"
#include "common/formats/height_map.hpp"
#include "common/formats/material_match.hpp"
#include "common/formats/schematic_writer.hpp"
#include "server/import/import_program.hpp"
#include "server/store/store.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/formats/file_builds.hpp"
#include "tests/support/formats/minecraft_bytes.hpp"
#include "tests/support/formats/schematic_bytes.hpp"

namespace runstone::test {
namespace {

void write_bytes(const std::string& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

ImportRequest request_of(const TempFolder& folder, const std::string& file) {
  ImportRequest request;
  request.kind = ImportKind::file;
  request.source = folder / file;
  request.world = folder / "world";
  request.edge = 32;
  request.keep_all = true;
  return request;
}

/// Writes a region of one chunk, 16 layers of stone from y = 0 on, and returns the folder of its
/// world.
std::string make_minecraft_world(const TempFolder& folder) {
  const std::string world = folder / "java";
  std::filesystem::create_directories(world + "/region");
  McSection section;
  section.y = 0;
  section.palette = {{"minecraft:stone", ""}};
  McChunk chunk;
  chunk.sections = {section};
  write_bytes(world + "/region/r.0.0.mca", mc_region({mc_slot(0, mc_chunk(chunk))}));
  return world;
}

Bytes level_dat(VoxelPos spawn) {
  NbtBytes out;
  out.open("").open("Data").i32("SpawnX", spawn.x).i32("SpawnY", spawn.y).i32("SpawnZ", spawn.z);
  return gzip_of(out.close().close().get());
}

}  // namespace

TEST_CASE("players arrive where level.dat of a Minecraft world says", "[import]") {
  const TempFolder folder;
  ImportRequest request = request_of(folder, "java");
  request.kind = ImportKind::minecraft;
  request.source = make_minecraft_world(folder);
  const std::string level = request.source + "/level.dat";
  std::string notice;
  VoxelPos expected{8, 16, 8};  // on top of the middle
  SECTION("in the air, where it stays") {
    expected = {3, 40, 5};
    write_bytes(level, level_dat(expected));
  }
  SECTION("in stone, from which it is raised") {
    expected = {3, 16, 5};
    write_bytes(level, level_dat({3, 4, 5}));
  }
  SECTION("beside the chunks, where nothing was imported") {
    write_bytes(level, level_dat({-500, 70, 5}));
  }
  SECTION("no level.dat") { notice = "level.dat: "; }
  SECTION("a damaged one") {
    write_bytes(level, {1, 2, 3});
    notice = "level.dat: ";
  }
  SECTION("one without a place") {
    NbtBytes empty;
    write_bytes(level, empty.open("").close().get());
    notice = "level.dat: says no place in the overworld: players arrive in the middle of the world";
  }
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? out.str() : imported.error()));
  REQUIRE(imported.has_value());
  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  CHECK((*store)->meta().spawn ==
        WorldPos{expected.x + 0.5, static_cast<double>(expected.y), expected.z + 0.5});
  CHECK((out.str().find("level.dat: ") != std::string::npos) == !notice.empty());
  CHECK(out.str().find(notice) != std::string::npos);
}

TEST_CASE("a schematic becomes a world whose voxels are those of the file", "[import]") {
  const TempFolder folder;
  SplitMix64 rng(5);
  const FileBuild build = random_file_build(rng, {50, 40, 70}, 20, true);
  const auto bytes = written(write_schem, build);
  REQUIRE(bytes.has_value());
  write_bytes(folder / "house.schem", *bytes);
  ImportRequest request = request_of(folder, "house.schem");
  request.at = {-13, 5, 1000};
  request.palette = false;
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? out.str() : imported.error()));
  REQUIRE(imported.has_value());
  CHECK(out.str().find("in a box of 50 x 40 x 70 became ") != std::string::npos);

  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const MaterialTable& table = (*store)->meta().materials;
  std::map<ChunkCoord, std::optional<Chunk>> chunks;
  const auto voxel = [&](VoxelPos at) {
    const ChunkCoord coord = chunk_of(at, 32);
    if (!chunks.contains(coord)) {
      auto chunk = (*store)->load_base({0, coord});
      REQUIRE(chunk.has_value());
      chunks[coord] = *std::move(chunk);
    }
    const std::optional<Chunk>& chunk = chunks[coord];
    return chunk ? material_at(chunk->voxels, local_of(at, 32)) : kEmpty;
  };
  std::size_t solid = 0;
  for (std::int32_t z = 0; z < 70; ++z) {
    for (std::int32_t y = 0; y < 40; ++y) {
      for (std::int32_t x = 0; x < 50; ++x) {
        const auto material = build.build->at({x, y, z});
        const BuildMaterial* expected =
            material ? &build.materials[*build.build->number_of(*material) - 1U] : nullptr;
        const VoxelPos at{x - 13, y + 5, z + 1000};
        const Material here = voxel(at);
        const bool is_empty = expected == nullptr || expected->row.visibility == Visibility::empty;
        REQUIRE((here == kEmpty) == is_empty);
        if (is_empty) continue;
        ++solid;
        REQUIRE(table[here].name == world_name_of(*expected));
      }
    }
  }
  CHECK(solid == build.build->solid());
}

TEST_CASE("an import makes a world of the materials that a map chooses", "[import]") {
  const TempFolder folder;
  SplitMix64 rng(5);
  const auto bytes = written(write_schem, random_file_build(rng, {20, 20, 20}, 6, true));
  REQUIRE(bytes.has_value());
  write_bytes(folder / "house.schem", *bytes);
  ImportRequest request = request_of(folder, "house.schem");
  request.palette = false;
  request.map = folder / "map.toml";
  std::ofstream(request.map) << "[materials]\n\"*\" = \"planks\"\n\"no:*\" = \"sand\"\n";
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? out.str() : imported.error()));
  REQUIRE(imported.has_value());
  CHECK(out.str().find("map.toml: these rows fit no material: \"no:*\"\n") != std::string::npos);
  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  const MaterialTable& table = (*store)->meta().materials;
  REQUIRE(table.size() == 2);
  CHECK(table[1].name == "planks");

  request.world = folder / "second";
  std::ofstream(request.map) << "[materials\n";
  const auto refused = import_world(request, out);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().find("map.toml:1: ") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));
}

TEST_CASE("a height map becomes a world with the colours of a second file", "[import]") {
  const TempFolder folder;
  const FileBuild build = file_build({3, 2, 2}, {file_material("a", "", {255, 0, 0, 255})},
                                     [](VoxelPos) { return std::uint16_t{1}; });
  write_bytes(folder / "land.png", *written(write_height_map, build));
  ImportRequest request = request_of(folder, "land.png");
  request.palette = false;
  request.colours = folder / "colours.png";
  write_bytes(request.colours, *written(write_colour_map, build));
  std::ostringstream out;
  const auto imported = import_world(request, out);
  INFO((imported ? out.str() : imported.error()));
  REQUIRE(imported.has_value());
  const auto store = open_world(request.world, StoreAccess::read_only);
  REQUIRE(store.has_value());
  REQUIRE((*store)->meta().materials.size() == 2);
  CHECK((*store)->meta().materials[1].name == "colour #ff0000");

  request.kind = ImportKind::minecraft;
  request.world = folder / "second";
  const auto refused = import_world(request, out);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().starts_with("--colours: only import file takes it"));
}

TEST_CASE("an import of a file that cannot be read makes no world", "[import]") {
  const TempFolder folder;
  write_bytes(folder / "bad.schem", {0, 1, 2});
  ImportRequest request = request_of(folder, "bad.schem");
  std::ostringstream out;
  auto imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("bad.schem: ") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));

  request.source = folder / "bad.exe";
  imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("the endings are .rsb") != std::string::npos);

  request.kind = ImportKind::minecraft;
  request.source = folder.path();
  imported = import_world(request, out);
  REQUIRE_FALSE(imported.has_value());
  CHECK(imported.error().find("no region file (r.X.Z.mca)") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(request.world));
}

}  // namespace runstone::test
