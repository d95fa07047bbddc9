#include "common/formats/vox.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <string>
#include <tuple>

#include "common/formats/look_material.hpp"
#include "tests/support/formats/file_builds.hpp"
#include "tests/support/formats/vox_bytes.hpp"

namespace runstone::test {
namespace {

const Format kVox{"vox", ".vox", read_vox, material_of_look, write_vox};

/// The names of voxels, by place in the scene.
using VoxelNames = std::map<std::tuple<std::int32_t, std::int32_t, std::int32_t>, std::string>;

VoxelNames vox_names(const Bytes& file) {
  VoxelNames out;
  const auto read = read_vox(file, [&](ForeignPiece&& piece) -> Result<void> {
    REQUIRE(validate_runs(piece.voxels).has_value());
    for (std::uint32_t i = 0; i < piece.voxels.volume(); ++i) {
      const LocalPos at = pos_of(i, piece.voxels.extent, piece.voxels.order);
      const Material material = material_at(piece.voxels, at);
      if (material != 0)
        out[{piece.origin.x + at.x, piece.origin.y + at.y, piece.origin.z + at.z}] =
            piece.blocks.at(material - 1U).name;
    }
    return {};
  });
  INFO((read ? "" : read.error().what));
  REQUIRE(read.has_value());
  return out;
}

Error vox_error(const Bytes& file) {
  const auto read = read_vox(file, [](ForeignPiece&&) { return Result<void>{}; });
  REQUIRE_FALSE(read.has_value());
  return read.error();
}

/// A palette in which every colour is different.
Bytes vox_palette() {
  Bytes content;
  for (unsigned i = 0; i < 256; ++i) {
    for (const unsigned part : {(i + 1) & 255U, 7U, 255 - i, 255U})
      content.push_back(static_cast<std::uint8_t>(part));
  }
  return vox_chunk("RGBA", content);
}

}  // namespace

TEST_CASE("a voxel of MagicaVoxel at x, y, z is at x, z, -1 - y, and nothing is mirrored",
          "[formats]") {
  // Without a scene graph and a palette: the default palette, and the last of two voxels counts.
  const Bytes file =
      vox_file({vox_chunk("PACK", {1, 0, 0, 0}), vox_model({2, 3, 4}, {{1, 2, 3, 9},
                                                                       {0, 0, 0, 1},
                                                                       {1, 0, 0, 215},
                                                                       {1, 2, 3, 216},
                                                                       {0, 1, 0, 255},
                                                                       {0, 2, 0, 0}})});
  CHECK(vox_names(file) == VoxelNames{{{1, 3, -3}, "colour #ee0000"},
                                      {{0, 0, -1}, "colour #ffffff"},
                                      {{1, 0, -1}, "colour #000033"},
                                      {{0, 0, -2}, "colour #111111"}});
}

TEST_CASE("models without a scene graph stand in a row", "[formats]") {
  const Bytes file = vox_file({vox_model({3, 1, 1}, {{0, 0, 0, 1}}), vox_model({2, 2, 2}, {}),
                               vox_model({1, 1, 1}, {{0, 0, 0, 2}})});
  CHECK(vox_names(file) ==
        VoxelNames{{{0, 0, -1}, "colour #ffffff"}, {{7, 0, -1}, "colour #ffffcc"}});
}

TEST_CASE("models are turned and mirrored as the scene says, in all 48 ways", "[formats]") {
  const std::array<std::int32_t, 3> sides = {3, 4, 5};
  std::vector<VoxVoxel> voxels;
  for (std::uint8_t z = 0; z < 5; ++z) {
    for (std::uint8_t y = 0; y < 4; ++y) {
      for (std::uint8_t x = 0; x < 3; ++x) {
        if ((x * 7 + y * 5 + z * 3) % 4 != 0)
          voxels.push_back({x, y, z, static_cast<std::uint8_t>(1 + x + 3 * (y + 4 * z))});
      }
    }
  }
  for (unsigned turn = 0; turn < 128; ++turn) {
    const unsigned first = turn & 3, second = turn >> 2 & 3;
    if (first == 3 || second == 3 || first == second) continue;
    CAPTURE(turn);
    const std::array<unsigned, 3> from = {first, second, 3 - first - second};
    const std::array<int, 3> shift = {10, -20, 30};
    const Bytes file =
        vox_file({vox_model(sides, voxels), vox_palette(),
                  vox_transform(0, 1, {{"_r", std::to_string(turn)}, {"_t", "10 -20 30"}}),
                  vox_shape(1, 0)});
    VoxelNames expected;
    for (const VoxVoxel& voxel : voxels) {
      std::array<int, 3> at{};
      for (unsigned i = 0; i < 3; ++i) {
        const double inside = voxel[from[i]] + 0.5 - sides[from[i]] / 2;
        at[i] = static_cast<int>(
            std::floor(((turn >> (4 + i) & 1) != 0 ? -inside : inside) + shift[i]));
      }
      char name[32];
      std::snprintf(name, sizeof name, "colour #%02x07%02x", voxel[3], 256 - voxel[3]);
      expected[{at[0], at[2], -1 - at[1]}] = name;
    }
    CHECK(vox_names(file) == expected);
  }
}

TEST_CASE("groups, instances, hidden nodes and hidden layers", "[formats]") {
  const std::vector<Bytes> models = {vox_model({1, 1, 1}, {{0, 0, 0, 1}}),
                                     vox_model({1, 1, 1}, {{0, 0, 0, 2}})};
  std::vector<Bytes> chunks = models;
  // A quarter turn around z: x becomes -y, and y becomes x.
  chunks.push_back(
      vox_transform(0, 1, {{"_r", std::to_string(1 | 0 << 2 | 1 << 4)}, {"_t", "100 0 0"}}));
  chunks.push_back(vox_group(1, {2, 4, 6, 8}));
  chunks.push_back(vox_transform(2, 3, {{"_t", "5 0 0"}}));
  chunks.push_back(vox_shape(3, 0));
  chunks.push_back(vox_transform(4, 3, {{"_t", "0 7 1"}}));
  chunks.push_back(vox_transform(6, 7, {}, {{"_hidden", "1"}}));
  chunks.push_back(vox_shape(7, 1));
  chunks.push_back(vox_transform(8, 7, {}, {}, 5));
  chunks.push_back(vox_numbered("LAYR", 5, {{"_hidden", "1"}}));
  // (5, 0, 0) becomes (100, 5, 0), and its voxel lies below the turned corner; (0, 7, 1) is at
  // (93, 0, 1).
  const VoxelNames expected = {{{99, 0, -6}, "colour #ffffff"}, {{92, 1, -1}, "colour #ffffff"}};
  CHECK(vox_names(vox_file(chunks)) == expected);
  chunks.back() = vox_numbered("LAYR", 5, {{"_name", "shown"}});
  CHECK(vox_names(vox_file(chunks)).size() == 3);
}

TEST_CASE("names come from notes, and looks from materials", "[formats]") {
  std::vector<std::string> notes(32);
  notes[31] = "wood";
  notes[30] = "water";
  Bytes note_bytes = {32, 0, 0, 0};
  for (const std::string& note : notes) {
    note_bytes.insert(note_bytes.end(), {static_cast<std::uint8_t>(note.size()), 0, 0, 0});
    note_bytes.insert(note_bytes.end(), note.begin(), note.end());
  }
  const Bytes file = vox_file(
      {vox_model({6, 1, 1},
                 {{0, 0, 0, 1}, {1, 0, 0, 8}, {2, 0, 0, 9}, {3, 0, 0, 17}, {4, 0, 0, 18}}),
       vox_palette(), vox_chunk("NOTE", note_bytes),
       vox_numbered("MATL", 9, {{"_type", "_glass"}, {"_trans", "0.25"}, {"_rough", "0.1"}}),
       vox_numbered("MATL", 17, {{"_type", "_emit"}, {"_emit", "0.5"}}),
       vox_numbered("MATL", 18, {{"_type", "_metal"}, {"_rough", "1e9"}}),
       vox_numbered("MATL", 256, {{"_type", "_glass"}})});
  CHECK(vox_names(file) == VoxelNames{{{0, 0, -1}, "wood #0107ff"},
                                      {{1, 0, -1}, "wood #0807f8"},
                                      {{2, 0, -1}, "water #0907f7bf rough 10"},
                                      {{3, 0, -1}, "colour #1107ef light 50"},
                                      {{4, 0, -1}, "colour #1207ee"}});
  const auto build = read_foreign_build(kVox, file, {.name = "notes"});
  REQUIRE(build.has_value());
  REQUIRE(build->materials.size() == 5);
  CHECK(build->materials[2].row.name == "water #0907f7bf rough 10");
  CHECK(build->materials[2].row.colour == MaterialColour{9, 7, 247, 191});
  CHECK(build->materials[2].row.visibility == Visibility::transparent);
  CHECK(build->materials[0].row.look->emission == 50);
}

TEST_CASE("bad .vox files are refused", "[formats]") {
  const Bytes model = vox_model({1, 1, 1}, {{0, 0, 0, 1}});
  const auto code = [](const std::vector<Bytes>& chunks) {
    return vox_error(vox_file(chunks)).code;
  };
  CHECK(code({vox_model({257, 1, 1}, {})}) == ErrorCode::bad_value);
  CHECK(code({vox_model({1, 0, 1}, {})}) == ErrorCode::bad_value);
  CHECK(code({vox_model({1, 1, -1}, {})}) == ErrorCode::bad_value);
  CHECK(code({vox_model({2, 1, 1}, {{2, 0, 0, 1}})}) == ErrorCode::bad_value);
  CHECK(code({vox_chunk("XYZI", {0, 0, 0, 0})}) == ErrorCode::bad_value);
  CHECK(code({vox_chunk("SIZE", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0})}) == ErrorCode::bad_value);
  CHECK(code({vox_chunk("SIZE", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}),
              vox_chunk("XYZI", {255, 255, 255, 255, 0, 0, 0, 1})}) == ErrorCode::truncated);
  CHECK(code({model, vox_transform(0, 1, {{"_r", "5"}}), vox_shape(1, 0)}) == ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {{"_r", "x"}}), vox_shape(1, 0)}) == ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {{"_t", "1 2"}}), vox_shape(1, 0)}) ==
        ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {{"_t", "0 0 99999999999999999999"}}), vox_shape(1, 0)}) ==
        ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {}), vox_shape(1, 1)}) == ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {}), vox_shape(2, 0)}) == ErrorCode::bad_value);
  CHECK(code({model, vox_transform(0, 1, {}), vox_shape(0, 0)}) == ErrorCode::bad_value);
  CHECK(vox_error(vox_file({model}, 151)).code == ErrorCode::bad_version);
  const Bytes far = vox_transform(0, 1, {{"_t", "500000000 0 0"}});
  CHECK(code({model, far, vox_transform(1, 2, {{"_t", "500000000 0 0"}}), vox_shape(2, 0)}) ==
        ErrorCode::bad_value);
  // Counts of 2^32 - 1.
  CHECK(code({vox_chunk("nGRP", {0, 0, 0, 0, 0, 0, 0, 0, 255, 255, 255, 255})}) ==
        ErrorCode::truncated);
  CHECK(code({vox_chunk("MATL", {1, 0, 0, 0, 255, 255, 255, 255})}) == ErrorCode::limit_exceeded);
  CHECK(code({vox_chunk("NOTE", {255, 255, 255, 255})}) == ErrorCode::limit_exceeded);
  CHECK(code({vox_chunk("NOTE", {1, 0, 0, 0, 255, 255, 255, 255, 'a'})}) == ErrorCode::truncated);
}

TEST_CASE("scenes with cycles and with too many nodes are refused", "[formats]") {
  const Bytes model = vox_model({1, 1, 1}, {{0, 0, 0, 1}});
  const auto what = [](const std::vector<Bytes>& chunks) {
    return std::string(vox_error(vox_file(chunks)).what);
  };
  CHECK(what({model, vox_transform(0, 1, {}), vox_group(1, {2}), vox_transform(2, 1, {})}) ==
        "vox: nodes of the scene form a cycle");
  CHECK(what({model, vox_transform(0, 0, {})}) == "vox: nodes of the scene form a cycle");
  // Each of 40 groups has the next one twice: 2^40 models.
  std::vector<Bytes> doubled = {model};
  for (std::int32_t i = 0; i < 40; ++i) doubled.push_back(vox_group(i, {i + 1, i + 1}));
  doubled.push_back(vox_shape(40, 0));
  CHECK(what(doubled) == "vox: the scene visits more than 65536 nodes");
  // A chain of 65,536 nodes is deep, and no more.
  std::vector<Bytes> deep = {model};
  for (std::int32_t i = 0; i < 65'535; ++i) deep.push_back(vox_transform(i, i + 1, {}));
  deep.push_back(vox_shape(65'535, 0));
  CHECK(vox_names(vox_file(deep)).size() == 1);
  deep.push_back(vox_group(65'536, {}));
  CHECK(what(deep) == "vox: the scene has more than 65536 nodes");
}

TEST_CASE("every .vox that is cut is refused", "[formats]") {
  const Bytes file = vox_file({vox_model({2, 2, 2}, {{0, 0, 0, 1}, {1, 1, 1, 2}}),
                               vox_numbered("MATL", 1, {{"_type", "_d"}}),
                               vox_transform(0, 1, {{"_t", "1 2 3"}}, {{"_name", "a"}}),
                               vox_group(1, {2}), vox_shape(2, 0), vox_numbered("LAYR", 0, {})});
  CHECK(lengths_without_error(kVox, file).empty());
  // The sizes of the head are those of the cut file.
  for (std::size_t length = 20; length < file.size(); ++length) {
    Bytes part(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(length));
    part[16] = static_cast<std::uint8_t>(length - 20);
    part[17] = static_cast<std::uint8_t>((length - 20) >> 8);
    static_cast<void>(read_vox(part, [](ForeignPiece&&) { return Result<void>{}; }));
  }
}

TEST_CASE("a build written as .vox is read with equal voxels, names, states and colours",
          "[formats]") {
  SplitMix64 rng{8};
  for (int round = 0; round < 12; ++round) {
    CAPTURE(round);
    const bool is_long = round % 4 == 0;
    const VoxelPos sides{rng.between(1, is_long ? 300 : 40), rng.between(1, 20),
                         rng.between(1, is_long ? 270 : 30)};
    FileBuild build = random_file_build(rng, sides, round == 0 ? 255 : 9, round % 2 == 0);
    build.info.author = "Anna";
    build.info.created_us = 1234567890123;
    build.info.origin = {-1000, 70, 3};
    build.materials.back().row.look = MaterialLook{1, 2, 3, 4, MaterialPattern::weave};
    const auto bytes = written(write_vox, build);
    REQUIRE(bytes.has_value());
    CHECK(*bytes == *written(write_vox, build));
    const auto read = read_foreign_build(kVox, *bytes, {});
    REQUIRE(read.has_value());
    CHECK(read->info == build.info);
    auto expected = cell_texts(build);
    // A .vox has no air.
    for (std::string& text : expected) {
      if (text == "air") text = "-";
    }
    CHECK(cell_texts(*read) == expected);
    const auto look_of_last = [](const FileBuild& of) {
      return of.materials.back().row.look == MaterialLook{1, 2, 3, 4, MaterialPattern::weave};
    };
    CHECK(look_of_last(*read) == look_of_last(build));
  }
}

TEST_CASE("builds with too many materials or without a voxel are not written", "[formats]") {
  std::vector<BuildMaterial> materials;
  for (int i = 0; i < 256; ++i)
    materials.push_back(file_material("m" + std::to_string(1000 + i), "", {1, 2, 3, 255}));
  const auto number = [](VoxelPos at) { return static_cast<std::uint16_t>(at.x + 1); };
  const auto refused = written(write_vox, file_build({256, 1, 1}, materials, number));
  REQUIRE_FALSE(refused.has_value());
  CHECK(std::string(refused.error().what) == "vox: build has more than 255 materials");
  CHECK(written(write_vox, file_build({255, 1, 1}, materials, number)).has_value());
  const auto air = file_build({1, 1, 1}, {file_material("air", "", {0, 0, 0, 0})},
                              [](VoxelPos) { return std::uint16_t{1}; });
  CHECK_FALSE(written(write_vox, air).has_value());
  const auto stone = file_build({1, 1, 1}, {materials[0]}, number);
  CHECK(write_vox(stone, [](ByteView) { return false; }).error().code == ErrorCode::io_failed);
}

TEST_CASE("a .vox has cubes in place of shapes, and none for one that fills less than half",
          "[formats][shapes]") {
  std::vector<BuildMaterial> materials = {file_material("slab", "", {1, 2, 3, 255}),
                                          file_material("torch", "", {4, 5, 6, 255})};
  materials[0].row.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  materials[1].row.shape = {ShapeForm::boxes, {{{7, 0, 7}, {9, 10, 9}}}};
  const FileBuild build = file_build(
      {2, 1, 1}, materials, [](VoxelPos at) { return static_cast<std::uint16_t>(at.x + 1); });
  const auto bytes = written(write_vox, build);
  REQUIRE(bytes.has_value());
  const auto read = read_foreign_build(kVox, *bytes, {});
  REQUIRE(read.has_value());
  REQUIRE(read->materials.size() == 1);
  CHECK(read->materials[0].row.name == "slab");
  CHECK(cell_texts(*read).at(1) == "-");
}

}  // namespace runstone::test
