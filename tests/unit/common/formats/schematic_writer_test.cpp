#include "common/formats/schematic_writer.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/builds/build_builder.hpp"
#include "common/core/hash.hpp"
#include "common/formats/deflate.hpp"
#include "common/formats/litematic_reader.hpp"
#include "common/formats/schematic_names.hpp"
#include "common/formats/schematic_reader.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/formats/foreign_cells.hpp"
#include "tests/support/formats/schematic_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

using SchemWriter = Result<void> (*)(const FileBuild&, const FormatSink&);
using SchemReader = Result<ForeignInfo> (*)(ByteView, const PieceSink&);

Result<void> write_schem_2(const FileBuild& file, const FormatSink& sink) {
  return write_schem_with(file, {.schem = SchemVersion::two}, sink);
}

struct SchemFormat {
  const char* name;
  SchemWriter write;
  SchemReader read;
};
constexpr SchemFormat kSchemFormats[] = {{"schem", write_schem, read_schematic},
                                         {"schem of version 2", write_schem_2, read_schematic},
                                         {"litematic", write_litematic, read_litematic}};

/// A cell: -1 is untouched, and other values are places in the list of materials.
using SchemCells = std::vector<std::int32_t>;  // (y * length + z) * width + x

BuildMaterial schem_material(std::string name, std::string states = "") {
  BuildMaterial out;
  out.row.name = std::move(name);
  out.states = std::move(states);
  if (out.row.name == "air") out.row.visibility = Visibility::empty;
  return out;
}

/// Makes a build whose sections have the given edges and random axis orders. The material of place
/// i is i.
FileBuild schem_file_build(SplitMix64& random, VoxelPos sides, const SchemCells& cells,
                           const std::vector<BuildMaterial>& materials, std::int32_t edge) {
  auto builder = BuildBuilder::of(
      {grid_cuts(sides.x, edge), grid_cuts(sides.y, edge, edge / 3), grid_cuts(sides.z, edge)});
  REQUIRE(builder.has_value());
  const BuildCuts cuts = builder->cuts();
  for (std::uint32_t sz = 0; sz + 1 < cuts[2].size(); ++sz) {
    for (std::uint32_t sy = 0; sy + 1 < cuts[1].size(); ++sy) {
      for (std::uint32_t sx = 0; sx + 1 < cuts[0].size(); ++sx) {
        const VoxelPos low{cuts[0][sx], cuts[1][sy], cuts[2][sz]};
        const VoxelPos high{cuts[0][sx + 1], cuts[1][sy + 1], cuts[2][sz + 1]};
        RunBuilder runs(
            {static_cast<std::uint8_t>(high.x - low.x), static_cast<std::uint8_t>(high.y - low.y),
             static_cast<std::uint8_t>(high.z - low.z)},
            AxisOrder::xyz);
        for (std::int32_t z = low.z; z < high.z; ++z) {
          for (std::int32_t y = low.y; y < high.y; ++y) {
            for (std::int32_t x = low.x; x < high.x; ++x) {
              const std::int32_t cell =
                  cells[static_cast<std::size_t>((y * sides.z + z) * sides.x + x)];
              runs.append(
                  1, cell < 0 ? Material{0} : *builder->number_of(static_cast<Material>(cell)));
            }
          }
        }
        const RunChunk section = reorder(runs.finish(), kAxisOrders[random.below(6)]);
        REQUIRE(builder->put({sx, sy, sz}, section).has_value());
      }
    }
  }
  auto build = builder->finish();
  REQUIRE(build.has_value());
  FileBuild out{{}, *std::move(build), {}};
  out.info.name = "castle \xf0\x9f\x8f\xb0";
  for (const Material material : out.build->palette()) out.materials.push_back(materials[material]);
  return out;
}

Bytes schem_bytes(SchemWriter write, const FileBuild& file) {
  Bytes out;
  const auto written = write(file, [&](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  });
  INFO((written ? "" : written.error().what));
  REQUIRE(written.has_value());
  return out;
}

/// Returns name and states of the material that a block of a file becomes.
std::string schem_material_text(const std::string& block) {
  const std::size_t open = std::min(block.find('['), block.size());
  ForeignBlock read{block.substr(0, open), ""};
  if (open < block.size()) read.states = block.substr(open + 1, block.size() - open - 2);
  const MaterialInfo info = material_of_schematic_block(read, true);
  REQUIRE(
      validate_material(info.name, info.colour, info.visibility, info.body, info.look).has_value());
  return info.name + "|" + (info.name == "air" ? "" : read.states);
}

std::vector<BuildMaterial> schem_materials() {
  return {
      schem_material("air"),
      schem_material("minecraft:stone"),
      schem_material("minecraft:oak_stairs", "facing=north,half=bottom"),
      schem_material("minecraft:oak_stairs[facing=east]",
                     "facing=east,half=bottom,shape=straight,waterlogged=false"),
      schem_material("grass"),
      schem_material("red bricks"),
      schem_material("Stra\xc3\x9f"
                     "e_1.[x]",
                     "any thing"),
      schem_material("default:chest", "param2=3"),
      schem_material("default:chest"),
      schem_material("default:furnace"),
      schem_material("minecraft:structure_void"),
      schem_material("runstone:red_bricks"),
      schem_material("red_bricks", "b=1,a=2"),
      schem_material("a:b", "runstone=x"),
      schem_material("a:b", "x=y,"),
      schem_material("minecraft:stone_like", "axis=y"),
      schem_material("mod:long_name#0123456789abcdef", "a=b"),
  };
}

}  // namespace

TEST_CASE("a build that was written as a schematic is read with its cells, names and states",
          "[formats]") {
  SplitMix64 random(7);
  const std::vector<BuildMaterial> materials = schem_materials();
  for (int round = 0; round < 12; ++round) {
    const VoxelPos sides{random.between(1, round % 3 == 0 ? 200 : 30), random.between(1, 40),
                         random.between(1, round % 4 == 0 ? 150 : 30)};
    SchemCells cells;
    const auto volume = static_cast<std::size_t>(sides.x * sides.y * sides.z);
    while (cells.size() < volume) {
      const std::size_t count = std::min<std::size_t>(1 + random.below(60), volume - cells.size());
      cells.insert(cells.end(), count,
                   random.between(-1, static_cast<std::int32_t>(materials.size()) - 1));
    }
    cells[volume / 2] = 1;
    const FileBuild file = schem_file_build(random, sides, cells, materials, random.between(9, 64));
    for (const auto& [name, write, read] : kSchemFormats) {
      CAPTURE(round, name);
      const std::uint64_t dense = dense_expansions();
      const Bytes bytes = schem_bytes(write, file);
      CHECK(dense_expansions() == dense);
      CHECK(schem_bytes(write, file) == bytes);  // deterministic
      const auto back = read_foreign_cells(read, bytes);
      REQUIRE(back.has_value());
      CHECK(back->box == VoxelBox{{0, 0, 0}, sides});
      CHECK(back->info.name == file.info.name);
      std::map<std::string, std::string> texts;  // of materials, by block
      std::size_t touched = 0, wrong = 0;
      for (std::size_t i = 0; i < volume; ++i) {
        if (cells[i] < 0) continue;
        ++touched;
        const auto at = static_cast<std::int32_t>(i);
        const auto found =
            back->blocks.find({at % sides.x, at / (sides.x * sides.z), at / sides.x % sides.z});
        if (found == back->blocks.end()) {
          ++wrong;
          continue;
        }
        auto [text, is_new] = texts.try_emplace(found->second);
        if (is_new) text->second = schem_material_text(found->second);
        const BuildMaterial& wanted = materials[static_cast<std::size_t>(cells[i])];
        // The name of a material of Minecraft has its states.
        const std::string wanted_name = wanted.row.name == "minecraft:stone_like"
                                            ? "minecraft:stone_like[axis=y]"
                                            : wanted.row.name;
        wrong += text->second != wanted_name + "|" + wanted.states ? 1u : 0u;
      }
      CHECK(wrong == 0);
      CHECK(touched == back->blocks.size());
    }
  }
}

TEST_CASE("the info of a build is kept", "[formats]") {
  SplitMix64 random(3);
  FileBuild file =
      schem_file_build(random, {2, 1, 1}, {0, -1}, {schem_material("minecraft:stone")}, 64);
  file.info.author = "me";
  file.info.created_us = 1'600'000'000'123'000;
  file.info.origin = {-5, 70, 1 << 20};
  for (const auto& [name, write, read] : kSchemFormats) {
    CAPTURE(name);
    const auto back = read_foreign_cells(read, schem_bytes(write, file));
    REQUIRE(back.has_value());
    CHECK(back->info.name == file.info.name);
    CHECK(back->info.author == "me");
    CHECK(back->info.created_us == file.info.created_us);
    // Litematica keeps no place in a world.
    CHECK(back->info.origin == (read == read_schematic ? file.info.origin : VoxelPos{}));
  }
}

TEST_CASE("more than 128 blocks take two bytes a cell, and more bits", "[formats]") {
  SplitMix64 random(9);
  std::vector<BuildMaterial> materials;
  for (int i = 0; i < 20'000; ++i) materials.push_back(schem_material("m:" + std::to_string(i)));
  SchemCells cells;
  for (std::int32_t i = 0; i < 20'000; ++i) cells.push_back(i);
  const FileBuild file = schem_file_build(random, {100, 10, 20}, cells, materials, 64);
  for (const auto& [name, write, read] : kSchemFormats) {
    CAPTURE(name);
    const auto back = read_foreign_cells(read, schem_bytes(write, file));
    REQUIRE(back.has_value());
    REQUIRE(back->blocks.size() == cells.size());
    std::size_t wrong = 0;
    for (const auto& [at, block] : back->blocks)
      wrong += block != "m:" + std::to_string((at.y * 20 + at.z) * 100 + at.x) ? 1u : 0u;
    CHECK(wrong == 0);
  }
}

TEST_CASE("a block of Minecraft without states is written with its default ones", "[formats]") {
  CHECK(schematic_text_of(schematic_block_of(schem_material("minecraft:oak_log"))) ==
        "minecraft:oak_log[axis=y]");
  CHECK(schematic_text_of(schematic_block_of(schem_material("minecraft:oak_log[axis=x]"))) ==
        "minecraft:oak_log[axis=x]");
  CHECK(schematic_text_of(schematic_block_of(schem_material("minecraft:stone"))) ==
        "minecraft:stone");
  CHECK(schematic_text_of(schematic_block_of(schem_material("air"))) == "minecraft:air");
}

TEST_CASE("names that the game does not allow are written by a rule", "[formats]") {
  const auto name_of = [](const char* name) {
    return schematic_block_of(schem_material(name)).name;
  };
  CHECK(name_of("grass") == "runstone:grass");
  CHECK(name_of("red bricks") == "runstone:red_bricks");
  CHECK(name_of("red_bricks") == "runstone:red.5fbricks");
  CHECK(name_of("Stone 2.0") == "runstone:.53tone_2.2e0");
  CHECK(name_of("caf\xc3\xa9/bar-1") == "runstone:caf.c3.a9/bar-1");
  CHECK(name_of("minecraft:structure_void") == "runstone:minecraft.3astructure.5fvoid");
  CHECK(schematic_block_of(schem_material("a:b", "Any")).states == "runstone=_41ny");
  // Every name of one or two bytes is written as one of its own.
  std::set<std::string> names;
  for (int a = 0; a < 128; ++a) {
    for (int b = 0; b < 128; ++b) {
      const std::string name{static_cast<char>(a), static_cast<char>(b)};
      const std::string written = name_of(name.c_str());
      if (a == 0 || b == 0) continue;
      CHECK(names.insert(written).second);
      if (a >= 32 && b >= 32 && a != 127 && b != 127)
        CHECK(material_of_schematic_block({written, ""}, false).name == name);
    }
  }
}

TEST_CASE("a schematic in a namespace of Runstone that no rule made keeps its name", "[formats]") {
  for (const char* name : {"runstone:A", "runstone:.4", "runstone:.zz", "runstone:.61",
                           "runstone:", "runstone:air", "runstone:.00"}) {
    CAPTURE(name);
    const MaterialInfo info = material_of_schematic_block({name, ""}, true);
    CHECK(info.name != "air");
    CHECK(validate_material(info.name, info.colour, info.visibility, info.body, info.look)
              .has_value());
  }
}

TEST_CASE("the first bytes of a written schematic are those of the format", "[formats][golden]") {
  SplitMix64 random(3);
  const FileBuild file =
      schem_file_build(random, {2, 1, 1}, {0, -1}, {schem_material("minecraft:stone")}, 64);
  const Bytes packed = schem_bytes(write_schem, file);
  REQUIRE(packed.size() > 10);
  CHECK(Bytes(packed.begin(), packed.begin() + 4) == Bytes{0x1f, 0x8b, 8, 0});
  Bytes plain;
  REQUIRE(inflate_all(packed, 0, DeflateForm::gzip, 10'000, &plain).has_value());
  NbtBytes wanted;
  wanted.open("").open("Schematic").i32("Version", 3).i32("DataVersion", 2975);
  wanted.open("Metadata").text("Name", "castle \xed\xa0\xbc\xed\xbf\xb0");
  wanted.open("WorldEdit").ints("Origin", {0, 0, 0}).close().close();
  wanted.i16("Width", 2).i16("Height", 1).i16("Length", 1).ints("Offset", {0, 0, 0});
  wanted.open("Blocks").open("Palette").i32("minecraft:stone", 0);
  wanted.i32("minecraft:structure_void", 1).close().bytes("Data", {0, 1});
  wanted.list("BlockEntities", 10, 0).close().close().close();
  CHECK(plain == wanted.get());
}

TEST_CASE("a schematic of version 2 has its entries in the outermost compound",
          "[formats][golden]") {
  SplitMix64 random(3);
  FileBuild file =
      schem_file_build(random, {2, 1, 1}, {0, -1}, {schem_material("minecraft:stone")}, 64);
  file.info.origin = {-7, 64, 9};
  Bytes plain;
  REQUIRE(inflate_all(schem_bytes(write_schem_2, file), 0, DeflateForm::gzip, 10'000, &plain)
              .has_value());
  NbtBytes wanted;
  wanted.open("Schematic").i32("Version", 2).i32("DataVersion", 2975);
  wanted.open("Metadata").text("Name", "castle \xed\xa0\xbc\xed\xbf\xb0");
  wanted.i32("WEOffsetX", 0).i32("WEOffsetY", 0).i32("WEOffsetZ", 0).close();
  wanted.i16("Width", 2).i16("Height", 1).i16("Length", 1).ints("Offset", {-7, 64, 9});
  wanted.i32("PaletteMax", 2).open("Palette").i32("minecraft:stone", 0);
  wanted.i32("minecraft:structure_void", 1).close().bytes("BlockData", {0, 1});
  wanted.list("BlockEntities", 10, 0).close();
  CHECK(plain == wanted.get());
}

TEST_CASE("a build that a schematic cannot hold is refused before anything is written",
          "[formats]") {
  const auto uniform = [](VoxelPos sides) {
    auto builder = BuildBuilder::of(
        {grid_cuts(sides.x, 128), grid_cuts(sides.y, 128), grid_cuts(sides.z, 128)});
    REQUIRE(builder.has_value());
    const auto number = builder->number_of(Material{1});
    REQUIRE(builder
                ->put({0, 0, 0}, uniform_chunk({static_cast<std::uint8_t>(std::min(sides.x, 128)),
                                                static_cast<std::uint8_t>(std::min(sides.y, 128)),
                                                static_cast<std::uint8_t>(std::min(sides.z, 128))},
                                               *number))
                .has_value());
    return FileBuild{{}, *builder->finish(), {schem_material("minecraft:stone")}};
  };
  const auto error_of = [](SchemWriter write, const FileBuild& file) {
    const auto written = write(file, [](ByteView) {
      FAIL("something was written");
      return true;
    });
    REQUIRE_FALSE(written.has_value());
    return written.error().code;
  };
  CHECK(error_of(write_schem, uniform({65'536, 1, 1})) == ErrorCode::limit_exceeded);
  CHECK(error_of(write_schem_2, uniform({65'536, 1, 1})) == ErrorCode::limit_exceeded);
  CHECK(error_of(write_schem, uniform({2048, 1024, 1024})) == ErrorCode::limit_exceeded);
  CHECK(error_of(write_litematic, uniform({2048, 1024, 1024})) == ErrorCode::limit_exceeded);
  const auto failed = write_schem(uniform({8, 8, 8}), [](ByteView) { return false; });
  REQUIRE_FALSE(failed.has_value());
  CHECK(failed.error().code == ErrorCode::io_failed);
  CHECK_FALSE(write_litematic(uniform({8, 8, 8}), [](ByteView) { return false; }));
}
