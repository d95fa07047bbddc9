// A box of a world becomes a Luanti world, which an import reads with the same voxels and names.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <string>

#include "common/formats/luanti_names.hpp"
#include "server/history/build_at.hpp"
#include "server/import/import_luanti.hpp"
#include "server/replay/command_world.hpp"
#include "server/replay/export_luanti.hpp"
#include "tests/support/core/temp_folder.hpp"
#include "tests/support/replay/run_replay.hpp"
#include "tests/support/store/sample_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Makes a world of terrain with edits, some of whose materials have names that Luanti does not
/// allow.
void make_edited_world(const std::string& folder, std::uint16_t edge) {
  WorldMeta meta = sample_meta();
  meta.chunk_edge = edge;
  meta.generator = {"terrain", 1, 77, ""};
  for (const char* name :
       {"default:dirt", "minecraft:oak_stairs[facing=east]", "é ~", "ignore",
        "runstone:red__bricks", "my flower", "stairs:stair_wood[param2=20]", "é ~[param2=1]"})
    REQUIRE(
        meta.materials.add({name, {1, 2, 3, 255}, Visibility::opaque, std::nullopt}).has_value());
  auto store = create_world(folder, meta);
  REQUIRE(store.has_value());
  REQUIRE((*store)->raise_epoch().has_value());
  SplitMix64 rng(7);
  const std::vector<PlayerRow> players = {sample_player(1), sample_player(2)};
  std::vector<EditRecord> records = sample_records(rng, 1, 1, 90);
  const auto count = static_cast<std::uint32_t>(meta.materials.size());
  for (EditRecord& record : records) {
    // A paste has materials of its own. Half of the others have one of the names above.
    if (!std::holds_alternative<Paste>(record.edit.shape))
      record.edit.material =
          static_cast<Material>(rng.below(2) == 0 ? count - 1 - rng.below(8) : rng.below(count));
  }
  REQUIRE((*store)->append(players, records).has_value());
}

std::string text_in(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("a box of a world is exported as a Luanti world and imported with the same voxels",
          "[server][replay][import]") {
  const TempFolder folder;
  const std::string world = folder / "world", luanti = folder / "luanti";
  const auto edge = GENERATE(as<std::uint16_t>{}, 16, 64);
  make_edited_world(world, edge);
  const VoxelBox box{{-37, -21, -40}, {43, 30, 39}};
  const ReplayOutcome done =
      run_replay({"export", "--world", world, "--box", "-37,-21,-40,42,29,38", "--luanti", luanti,
                  "--name", "My town"});
  INFO(done.out << done.err);
  REQUIRE(done.code == 0);
  CHECK(done.out.find("80 x 51 x 79 voxels, ") != std::string::npos);
  CHECK(text_in(luanti + "/world.mt").find("world_name = My town\n") != std::string::npos);
  CHECK(text_in(luanti + "/map_meta.txt").find("mg_name = singlenode\n") != std::string::npos);

  std::map<ChunkKey, RunChunk> chunks;
  MaterialTable table;
  const LuantiImportSink sink{[&](const MaterialTable& materials) { table = materials; },
                              [&](const ChunkKey& key, RunChunk&& chunk) {
                                chunks.emplace(key, std::move(chunk));
                                return true;
                              },
                              {}};
  const auto report = import_luanti(luanti, {.edge = 32}, sink);
  REQUIRE(report.has_value());
  CHECK(report->damaged.empty());
  const auto imported = [&](VoxelPos at) -> std::string {
    const auto found = chunks.find({0, chunk_of(at, 32)});
    return found == chunks.end() ? "air" : table[material_at(found->second, local_of(at, 32))].name;
  };

  const auto source = open_for_reading(world);
  REQUIRE(source.has_value());
  const auto then =
      WorldAt::open(*source->store, *source->generator, *source->store->last_sequence());
  REQUIRE(then.has_value());
  const auto materials = source->store->materials(kSequenceMax);
  REQUIRE(materials.has_value());
  const auto build = build_at(*then, *source->store, *materials, box, edge, kBuildBytesMax,
                              [](std::uint64_t, std::uint64_t) { return true; });
  REQUIRE(build.has_value());
  std::size_t wrong = 0, solid = 0;
  std::set<std::string> names;
  for (std::int32_t z = box.min.z - 16; z < box.max.z + 16; ++z) {
    for (std::int32_t y = box.min.y - 16; y < box.max.y + 16; ++y) {
      for (std::int32_t x = box.min.x - 16; x < box.max.x + 16; ++x) {
        std::string expected = "air";
        if (box.contains({x, y, z})) {
          const auto material = build->build->at({x - box.min.x, y - box.min.y, z - box.min.z});
          if (*material != kEmpty) expected = (*materials)[*material].name;
        }
        if (expected != "air") ++solid;
        names.insert(expected);
        if (imported({x, y, z}) != expected) ++wrong;
      }
    }
  }
  CHECK(wrong == 0);
  CHECK(solid == build->build->solid());
  CHECK(done.out.find(" voxels, " + std::to_string(solid) + " of them not empty") !=
        std::string::npos);
  CHECK(names.contains("runstone:red__bricks"));  // or the test shows little
  CHECK(names.contains("\xc3\xa9 ~"));
  CHECK(names.contains("\xc3\xa9 ~[param2=1]"));
  CHECK(names.contains("stairs:stair_wood[param2=20]"));
}

TEST_CASE("an export as a Luanti world refuses what Luanti cannot hold, and makes no folder",
          "[server][replay][import]") {
  const TempFolder folder;
  const std::string world = folder / "world", luanti = folder / "luanti";
  make_edited_world(world, 16);
  const auto refusal = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"export", "--world", world});
    const ReplayOutcome outcome = run_replay(arguments);
    CHECK(outcome.code == 2);
    CHECK_FALSE(std::filesystem::exists(luanti));
    return outcome.err;
  };
  CHECK(refusal({"--luanti", luanti}).find("--box is missing") != std::string::npos);
  CHECK(refusal({"--luanti", luanti, "--box", "0,0,0,1,1,30928"})
            .find("the coordinates -30912 to 30927 along each axis") != std::string::npos);
  CHECK(refusal({"--luanti", luanti, "--box", "-30913,0,0,1,1,1"}).find("reaches beyond") !=
        std::string::npos);
  CHECK(refusal({"--luanti", luanti, "--box", "0,0,0,1,1,1", folder / "a.schem"})
            .find("FILE and --luanti: give one of them") != std::string::npos);
  CHECK(refusal({}).find("FILE is missing") != std::string::npos);
  CHECK(luanti_box_refusal({{-30912, -30912, -30912}, {30928, 30928, 30928}}).empty());
  std::filesystem::create_directory(folder / "full");
  std::ofstream(folder / "full/notes.txt") << "x";
  CHECK(refusal({"--luanti", folder / "full", "--box", "0,0,0,1,1,1"}).find("full") !=
        std::string::npos);
}
