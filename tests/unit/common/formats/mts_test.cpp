#include "common/formats/mts.hpp"

#include <zlib.h>

#include <catch2/catch.hpp>
#include <string>

#include "common/formats/look_material.hpp"
#include "common/formats/luanti_block.hpp"
#include "tests/support/formats/file_builds.hpp"

namespace runstone::test {
namespace {

const Format kMts{"luanti schematic", ".mts", read_mts, material_of_luanti_node, write_mts};

/// Every field can be set wrong.
struct MtsFields {
  std::uint16_t version = 4;
  std::array<std::uint16_t, 3> sides = {2, 1, 2};
  Bytes layers = {127};
  std::vector<std::string> names = {"air", "default:stone", "ignore"};
  Bytes nodes;  // ids, chances and param2
};

Bytes mts_file(const MtsFields& fields) {
  Bytes out = {'M', 'T', 'S', 'M'};
  const auto u16 = [&](std::size_t number) {
    out.push_back(static_cast<std::uint8_t>(number >> 8));
    out.push_back(static_cast<std::uint8_t>(number));
  };
  u16(fields.version);
  for (const std::uint16_t side : fields.sides) u16(side);
  if (fields.version >= 3) out.insert(out.end(), fields.layers.begin(), fields.layers.end());
  u16(fields.names.size());
  for (const std::string& name : fields.names) {
    u16(name.size());
    out.insert(out.end(), name.begin(), name.end());
  }
  Bytes packed(compressBound(fields.nodes.size()));
  uLongf size = packed.size();
  REQUIRE(compress(packed.data(), &size, fields.nodes.data(), fields.nodes.size()) == Z_OK);
  out.insert(out.end(), packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
  return out;
}

std::vector<std::string> mts_names(const Bytes& file) {
  const auto build = read_foreign_build(kMts, file, {});
  INFO((build ? "" : build.error().what));
  REQUIRE(build.has_value());
  std::vector<std::string> out;
  for (const std::string& text : cell_texts(*build))
    out.push_back(text.substr(0, text.find_last_of('|')));
  return out;
}

Error mts_error(const Bytes& file) {
  const auto read = read_mts(file, [](ForeignPiece&&) { return Result<void>{}; });
  REQUIRE_FALSE(read.has_value());
  return read.error();
}

}  // namespace

TEST_CASE("a schematic of Luanti is read: names, param2, and nodes that are never placed",
          "[formats]") {
  MtsFields fields;
  fields.nodes = {0, 0, 0, 1, 0, 1, 0, 2, 127, 64, 128 | 1, 127, 9, 0, 23, 0};
  CHECK(mts_names(mts_file(fields)) ==
        std::vector<std::string>{"air", "default:stone|", "default:stone|param2=23", "-"});
  // The highest bit is a flag in version 4, and 0 is never.
  fields.nodes[9] = 128;
  CHECK(mts_names(mts_file(fields))[1] == "-");
  fields.version = 3;
  CHECK(mts_names(mts_file(fields))[1] == "default:stone|");
  fields.version = 2;
  fields.nodes[9] = 0;
  CHECK(mts_names(mts_file(fields))[1] == "-");
  fields.version = 1;
  CHECK(mts_names(mts_file(fields))[1] == "default:stone|");
  fields.version = 4;
  fields.sides = {1, 2, 2};
  fields.layers = {127, 128};
  fields.nodes[9] = 127;
  CHECK(mts_names(mts_file(fields)) ==
        std::vector<std::string>{"air", "-", "default:stone|param2=23", "-"});
}

TEST_CASE("bad schematics of Luanti are refused", "[formats]") {
  MtsFields good;
  good.nodes = {0, 0, 0, 1, 0, 1, 0, 2, 127, 127, 127, 127, 0, 0, 0, 0};
  const auto code = [&](auto&& change) {
    MtsFields fields = good;
    change(fields);
    return mts_error(mts_file(fields)).code;
  };
  CHECK(code([](MtsFields& f) { f.version = 5; }) == ErrorCode::bad_version);
  CHECK(code([](MtsFields& f) { f.version = 0; }) == ErrorCode::bad_version);
  CHECK(code([](MtsFields& f) { f.sides[2] = 0; }) == ErrorCode::bad_value);
  CHECK(code([](MtsFields& f) { f.nodes[7] = 3; }) == ErrorCode::bad_value);
  CHECK(code([](MtsFields& f) { f.nodes.pop_back(); }) == ErrorCode::truncated);
  CHECK(code([](MtsFields& f) { f.sides = {65535, 1, 65535}; }) == ErrorCode::truncated);
  CHECK(code([](MtsFields& f) { f.names.clear(); }) == ErrorCode::bad_value);
  Bytes damaged = mts_file(good);
  damaged[damaged.size() - 10] ^= 0xff;
  static_cast<void>(read_mts(damaged, [](ForeignPiece&&) { return Result<void>{}; }));
  CHECK(code([](MtsFields& f) { f.nodes.push_back(0); }) == ErrorCode::truncated);
  CHECK(lengths_without_error(kMts, mts_file(good)).empty());
}

TEST_CASE("a build written as .mts is read with equal voxels, names and states", "[formats]") {
  SplitMix64 rng{6};
  for (int round = 0; round < 10; ++round) {
    CAPTURE(round);
    const VoxelPos sides{rng.between(1, 140), rng.between(1, 30), rng.between(1, 30)};
    FileBuild build = random_file_build(rng, sides, round == 0 ? 300 : 9, round % 2 == 0);
    const std::string states[] = {"param2=7",   "a=b,param2=255",        "param2=0",
                                  "param2=256", "facing=north,half=top", "param2=07",
                                  "xparam2=9"};
    for (std::size_t i = 0; i < build.materials.size() && i < 7; ++i) {
      BuildMaterial& material = build.materials[i];
      if (material.row.visibility == Visibility::empty) continue;
      material.states = states[i];
      if (i == 6) material.row.name += "[1]";
    }
    const auto bytes = written(write_mts, build);
    REQUIRE(bytes.has_value());
    CHECK(*bytes == *written(write_mts, build));
    const auto read = read_foreign_build({"", "", read_mts, material_of_look, nullptr}, *bytes, {});
    REQUIRE(read.has_value());
    auto expected = cell_texts(build), found = cell_texts(*read);
    REQUIRE(expected.size() == found.size());
    // Colours are those of the names.
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      if (expected[i].substr(0, expected[i].rfind('|')) != found[i].substr(0, found[i].rfind('|')))
        ++wrong;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("the param2 in the name of a world's material becomes the param2 of a node",
          "[formats]") {
  const auto build = file_build({3, 1, 1},
                                {file_material("default:chest", "", {1, 2, 3, 255}),
                                 file_material("default:chest[param2=3]", "", {1, 2, 3, 255}),
                                 file_material("default:stone[1]", "", {1, 2, 3, 255})},
                                [](VoxelPos at) { return static_cast<std::uint16_t>(at.x + 1); });
  const auto bytes = written(write_mts, build);
  REQUIRE(bytes.has_value());
  const auto read = read_foreign_build({"", "", read_mts, material_of_look, nullptr}, *bytes, {});
  REQUIRE(read.has_value());
  REQUIRE(read->materials.size() == 3);
  CHECK(read->materials[0].row.name == "default:chest");
  CHECK(read->materials[0].states.empty());
  CHECK(read->materials[1].row.name == "default:chest");
  CHECK(read->materials[1].states == "param2=3");
  CHECK(read->materials[2].row.name == "default:stone[1]");
}

TEST_CASE("builds that are longer than a schematic are not written", "[formats]") {
  const auto build = file_build({65'536, 1, 1}, {file_material("a", "", {1, 2, 3, 255})},
                                [](VoxelPos) { return std::uint16_t{1}; });
  const auto refused = written(write_mts, build);
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("a param2 in the name of a material is that of its node", "[formats]") {
  const FileBuild build =
      file_build({3, 1, 1},
                 {file_material("stairs:stair_wood[param2=3]", "param2=3", {1, 2, 3, 255}),
                  file_material("stairs:stair_wood[param2=1]", "", {1, 2, 3, 255}),
                  file_material("stairs:stair_wood[a=b,param2=2]", "a=b,param2=2", {1, 2, 3, 255})},
                 [](VoxelPos at) { return static_cast<std::uint16_t>(at.x + 1); });
  const auto file = written(write_mts, build);
  REQUIRE(file);
  CHECK(mts_names(*file) ==
        std::vector<std::string>{"stairs:stair_wood[param2=3]|param2=3",
                                 "stairs:stair_wood[param2=1]|param2=1",
                                 "stairs:stair_wood[a=b,param2=2]|a=b,param2=2"});
}

}  // namespace runstone::test
