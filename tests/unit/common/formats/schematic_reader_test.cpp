#include "common/formats/schematic_reader.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/formats/deflate.hpp"
#include "common/runs/dense.hpp"
#include "tests/support/formats/foreign_cells.hpp"
#include "tests/support/formats/schematic_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

SpongeFields sponge_sample(std::int64_t version) {
  SpongeFields fields;
  fields.version = version;
  fields.sides = {3, 2, 2};
  fields.palette = {{"minecraft:oak_stairs[half=bottom,facing=north]", 7},
                    {"minecraft:air", 0},
                    {"stone", 200},
                    {"minecraft:structure_void", 3}};
  fields.cells = {0, 7, 0, 200, 0, 3, 0, 0, 0, 0, 0, 200};
  fields.name = "house";
  fields.author = "me";
  fields.date = 1'600'000'000'123;
  fields.offset = {-5, 64, 9};
  return fields;
}

MceditFields mcedit_sample() {
  MceditFields fields;
  fields.sides = {2, 1, 3};
  fields.blocks = {1, 35, 0, 217, 17, 200};
  fields.data = {0, 14, 0, 0, 5, 3};
  return fields;
}

ForeignCells cells_of_schematic(const Bytes& plain) {
  const auto read = read_foreign_cells(read_schematic, gzip_of(plain));
  INFO((read ? "" : read.error().what));
  REQUIRE(read.has_value());
  return *read;
}

Error schematic_error(const Bytes& plain) {
  const auto read = read_foreign_cells(read_schematic, plain);
  REQUIRE_FALSE(read.has_value());
  REQUIRE(read.error().what[0] != '\0');
  return read.error();
}

}  // namespace

TEST_CASE("a schematic of each version of Sponge is read", "[formats]") {
  for (const std::int64_t version : {1, 2, 3}) {
    for (const bool has_data_first : {false, true}) {
      CAPTURE(version, has_data_first);
      SpongeFields fields = sponge_sample(version);
      fields.has_data_first = has_data_first;
      const std::uint64_t dense = dense_expansions();
      const ForeignCells read = cells_of_schematic(sponge_plain(fields));
      CHECK(dense_expansions() == dense);
      CHECK(read.box == VoxelBox{{0, 0, 0}, {3, 2, 2}});
      CHECK(read.pieces == 1);
      CHECK(read.blocks.size() == 11);
      CHECK(read.blocks.at({0, 0, 0}) == "minecraft:air");
      CHECK(read.blocks.at({1, 0, 0}) == "minecraft:oak_stairs[facing=north,half=bottom]");
      CHECK(read.blocks.at({0, 0, 1}) == "minecraft:stone");
      CHECK(read.blocks.count({2, 0, 1}) == 0);
      CHECK(read.blocks.at({2, 1, 1}) == "minecraft:stone");
      CHECK(read.info.name == "house");
      CHECK(read.info.author == "me");
      CHECK(read.info.created_us == 1'600'000'000'123'000);
      CHECK(read.info.origin == VoxelPos{-5, 64, 9});
    }
  }
}

TEST_CASE("the origin of a schematic is where WorldEdit copied it", "[formats]") {
  SpongeFields fields = sponge_sample(3);
  fields.origin = {100, 1, -50};
  CHECK(cells_of_schematic(sponge_plain(fields)).info.origin == VoxelPos{95, 65, -41});
  fields.origin = {1 << 30, 0, 0};  // no world has such a place
  CHECK(cells_of_schematic(sponge_plain(fields)).info.origin == VoxelPos{});
  CHECK(cells_of_schematic(mcedit_plain(mcedit_sample())).info.origin == VoxelPos{100, -7, 3});
}

TEST_CASE("large schematics are cut at the planes of the grid of 64", "[formats]") {
  SplitMix64 random(47);
  for (const VoxelPos sides :
       {VoxelPos{130, 3, 70}, VoxelPos{64, 70, 2}, VoxelPos{5, 130, 66}, VoxelPos{65, 65, 1}}) {
    CAPTURE(sides.x, sides.y, sides.z);
    SpongeFields fields;
    fields.sides = sides;
    for (std::uint32_t i = 0; i < 300; ++i)
      fields.palette.emplace_back("mod:block_" + std::to_string(i), i);
    const auto volume = static_cast<std::size_t>(sides.x * sides.y * sides.z);
    while (fields.cells.size() < volume) {
      const std::size_t count =
          std::min<std::size_t>(random.below(90) + 1, volume - fields.cells.size());
      fields.cells.insert(fields.cells.end(), count, random.below(300));
    }
    const ForeignCells read = cells_of_schematic(sponge_plain(fields));
    const auto tiles = [](std::int32_t side) { return static_cast<std::size_t>((side + 63) / 64); };
    CHECK(read.pieces == tiles(sides.x) * tiles(sides.y) * tiles(sides.z));
    REQUIRE(read.blocks.size() == volume);
    std::size_t wrong = 0;
    for (const auto& [at, block] : read.blocks) {
      const auto i = static_cast<std::size_t>((at.y * sides.z + at.z) * sides.x + at.x);
      wrong += block != "mod:block_" + std::to_string(fields.cells[i]) ? 1u : 0u;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("a schematic that is all untouched keeps its sides", "[formats]") {
  SpongeFields fields;
  fields.sides = {65, 1, 1};
  fields.palette = {{"minecraft:structure_void", 0}};
  fields.cells.assign(65, 0);
  const ForeignCells read = cells_of_schematic(sponge_plain(fields));
  CHECK(read.box == VoxelBox{{0, 0, 0}, {65, 1, 1}});
  CHECK(read.blocks.empty());
}

TEST_CASE("a schematic of MCEdit is read by its numbers", "[formats]") {
  const ForeignCells read = cells_of_schematic(mcedit_plain(mcedit_sample()));
  CHECK(read.box == VoxelBox{{0, 0, 0}, {2, 1, 3}});
  CHECK(read.blocks.at({0, 0, 0}) == "minecraft:stone");
  CHECK(read.blocks.at({1, 0, 0}) == "minecraft:red_wool");
  CHECK(read.blocks.at({0, 0, 1}) == "minecraft:air");
  CHECK(read.blocks.count({1, 0, 1}) == 0);  // structure_void
  CHECK(read.blocks.at({0, 0, 2}) == "minecraft:spruce_log[axis=x]");
  CHECK(read.blocks.size() == 5);
}

TEST_CASE("numbers above 255 have their high bits in AddBlocks", "[formats]") {
  MceditFields fields;
  fields.sides = {3, 1, 1};
  fields.blocks = {1, 2, 3};
  fields.data = {0, 7, 0xf0};  // only the low bits of data count
  fields.add = {0x21, 0x03};
  const ForeignCells of_world_edit = cells_of_schematic(mcedit_plain(fields));
  CHECK(of_world_edit.blocks.at({0, 0, 0}) == "numeric:257");
  CHECK(of_world_edit.blocks.at({1, 0, 0}) == "numeric:514[data=7]");
  CHECK(of_world_edit.blocks.at({2, 0, 0}) == "numeric:771");
  // Schematica writes the halves of a byte in the other order, and names.
  fields.add = {0x12, 0x30};
  fields.mapping = {{"mod:lamp", 514}, {"minecraft:stone", 1}, {"mod:wire", 257}};
  const ForeignCells of_schematica = cells_of_schematic(mcedit_plain(fields));
  CHECK(of_schematica.blocks.at({0, 0, 0}) == "mod:wire");
  CHECK(of_schematica.blocks.at({1, 0, 0}) == "mod:lamp[data=7]");
  CHECK(of_schematica.blocks.at({2, 0, 0}) == "numeric:771");
}

TEST_CASE("a schematic may be compressed by gzip, by zlib or not", "[formats]") {
  const Bytes plain = sponge_plain(sponge_sample(2));
  const auto expected = cells_of_schematic(plain).blocks;
  CHECK(read_foreign_cells(read_schematic, plain)->blocks == expected);
  CHECK(read_foreign_cells(read_schematic, deflate_all(plain, DeflateForm::zlib))->blocks ==
        expected);
}

TEST_CASE("every truncation of a schematic is rejected", "[formats]") {
  for (const Bytes& plain : {sponge_plain(sponge_sample(2)), sponge_plain(sponge_sample(3)),
                             mcedit_plain(mcedit_sample())}) {
    for (std::size_t size = 0; size < plain.size(); ++size) {
      CAPTURE(size);
      const Bytes cut(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(size));
      CHECK(schematic_error(cut).code == ErrorCode::truncated);
    }
    const Bytes packed = gzip_of(plain);
    for (std::size_t size = 0; size < packed.size(); ++size) {
      CAPTURE(size);
      const Bytes cut(packed.begin(), packed.begin() + static_cast<std::ptrdiff_t>(size));
      CHECK(schematic_error(cut).code == ErrorCode::truncated);
    }
  }
}

TEST_CASE("cells and sides of a schematic have to agree", "[formats]") {
  const auto error_of = [](auto change) {
    SpongeFields fields = sponge_sample(2);
    change(fields);
    return schematic_error(sponge_plain(fields)).code;
  };
  CHECK(error_of([](auto& f) { f.cells.pop_back(); }) == ErrorCode::truncated);
  CHECK(error_of([](auto& f) { f.cells.push_back(0); }) == ErrorCode::trailing_bytes);
  CHECK(error_of([](auto& f) { f.cells.back() = 1; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.cells.back() = 0xffffffff; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.cells.clear(); }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.sides.x = 0; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.sides = {-1, -1, -1}; }) == ErrorCode::limit_exceeded);
  CHECK(error_of([](auto& f) { f.palette[1].second = 7; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.palette[1].second = -1; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.palette[1].second = 65'534; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& f) { f.version = 4; }) == ErrorCode::bad_version);
  CHECK(error_of([](auto& f) { f.version = 0; }) == ErrorCode::bad_version);

  const auto mcedit_error_of = [](auto change) {
    MceditFields fields = mcedit_sample();
    change(fields);
    return schematic_error(mcedit_plain(fields)).code;
  };
  CHECK(mcedit_error_of([](auto& f) { f.blocks.pop_back(); }) == ErrorCode::bad_value);
  CHECK(mcedit_error_of([](auto& f) { f.data.push_back(0); }) == ErrorCode::bad_value);
  CHECK(mcedit_error_of([](auto& f) { f.blocks.clear(); }) == ErrorCode::bad_value);
  CHECK(mcedit_error_of([](auto& f) { f.add = {1}; }) == ErrorCode::bad_value);
  CHECK(mcedit_error_of([](auto& f) { f.materials = "Pocket"; }) == ErrorCode::unknown_kind);
}

TEST_CASE("a number of a cell that never ends is rejected", "[formats]") {
  NbtBytes bytes;
  bytes.open("Schematic").i32("Version", 2).i16("Width", 1).i16("Height", 1).i16("Length", 1);
  bytes.open("Palette").i32("minecraft:stone", 0).close();
  bytes.bytes("BlockData", Bytes(20, 0x80)).close();
  CHECK(schematic_error(bytes.get()).code == ErrorCode::bad_value);
}

TEST_CASE("names of a schematic take 24 MiB at most", "[formats]") {
  SpongeFields fields;
  fields.sides = {1, 1, 1};
  fields.cells = {0};
  for (int i = 0; i < 500; ++i)
    fields.palette.emplace_back(std::string(60'000, 'a') + std::to_string(i), i);
  CHECK(schematic_error(gzip_of(sponge_plain(fields))).code == ErrorCode::limit_exceeded);
  MceditFields numbered = mcedit_sample();
  for (int i = 0; i < 500; ++i)
    numbered.mapping.emplace_back(std::string(60'000, 'a') + std::to_string(i), i);
  CHECK(schematic_error(gzip_of(mcedit_plain(numbered))).code == ErrorCode::limit_exceeded);
  // One long name with many data values.
  numbered.mapping = {{"a:" + std::string(60'000, 'a'), 300}};
  numbered.sides = {4096, 1, 1};
  numbered.blocks.assign(4096, 300 - 256);
  numbered.add.assign(2048, 0x11);
  numbered.data.assign(4096, 0);
  for (std::size_t i = 0; i < 16; ++i) numbered.data[i] = static_cast<std::uint8_t>(i);
  CHECK(cells_of_schematic(mcedit_plain(numbered)).blocks.size() == 4096);
}

TEST_CASE("arrays of 2^31 bytes that are not there are rejected", "[formats]") {
  for (const std::int64_t count : {0x7fffffffLL, -1LL, -0x80000000LL}) {
    NbtBytes bytes;
    bytes.open("Schematic").raw({7, 0, 9}).raw({'B', 'l', 'o', 'c', 'k', 'D', 'a', 't', 'a'});
    bytes.big(count, 4).raw({1, 2, 3});
    const ErrorCode code = schematic_error(bytes.get()).code;
    CHECK(code == (count < 0 ? ErrorCode::bad_value : ErrorCode::truncated));
  }
}

TEST_CASE("flipped bytes of a schematic give an error or sound pieces", "[formats]") {
  int rejected = 0;
  for (const Bytes& plain : {sponge_plain(sponge_sample(2)), sponge_plain(sponge_sample(3)),
                             mcedit_plain(mcedit_sample())}) {
    for (std::size_t i = 0; i < plain.size(); ++i) {
      for (const int mask : {1, 0x80, 0xff}) {
        Bytes flipped = plain;
        flipped[i] = static_cast<std::uint8_t>(flipped[i] ^ mask);
        rejected += static_cast<int>(!read_foreign_cells(read_schematic, flipped));
      }
    }
  }
  CHECK(rejected > 0);
}

TEST_CASE("the error of the sink ends the reading of a schematic", "[formats]") {
  const auto read = read_schematic(sponge_plain(sponge_sample(2)), [](ForeignPiece&&) {
    return Result<void>(fail(ErrorCode::limit_exceeded, "full"));
  });
  REQUIRE_FALSE(read.has_value());
  CHECK(read.error().code == ErrorCode::limit_exceeded);
}
