#include "common/formats/litematic_reader.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "tests/support/formats/foreign_cells.hpp"
#include "tests/support/formats/schematic_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

LitematicRegionFields region_sample() {
  LitematicRegionFields region;
  region.size = {2, 2, 3};
  region.palette = {{"minecraft:air", {}},
                    {"minecraft:oak_stairs", {{"half", "bottom"}, {"facing", "north"}}},
                    {"minecraft:structure_void", {}},
                    {"stone", {}}};
  region.longs = packed_longs({0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 3}, 2);
  return region;
}

ForeignCells cells_of_litematic(const std::vector<LitematicRegionFields>& regions) {
  const auto read = read_foreign_cells(read_litematic, gzip_of(litematic_plain(regions)));
  INFO((read ? "" : read.error().what));
  REQUIRE(read.has_value());
  return *read;
}

Error litematic_error(const Bytes& file) {
  const auto read = read_foreign_cells(read_litematic, file);
  REQUIRE_FALSE(read.has_value());
  REQUIRE(read.error().what[0] != '\0');
  return read.error();
}

}  // namespace

TEST_CASE("a region of Litematica is read", "[formats]") {
  const ForeignCells read = cells_of_litematic({region_sample()});
  CHECK(read.box == VoxelBox{{0, 0, 0}, {2, 2, 3}});
  CHECK(read.blocks.size() == 11);
  CHECK(read.blocks.at({0, 0, 0}) == "minecraft:air");
  CHECK(read.blocks.at({1, 0, 0}) == "minecraft:oak_stairs[facing=north,half=bottom]");
  CHECK(read.blocks.count({0, 0, 1}) == 0);
  CHECK(read.blocks.at({1, 0, 1}) == "minecraft:stone");
  CHECK(read.blocks.at({1, 1, 2}) == "minecraft:stone");
  CHECK(read.info.name == "house");
  CHECK(read.info.author == "me");
  CHECK(read.info.created_us == 1'234'000);
}

TEST_CASE("a negative side reaches from the position downwards", "[formats]") {
  LitematicRegionFields region = region_sample();
  region.position = {10, -20, 30};
  region.size = {-2, 2, -3};
  const ForeignCells read = cells_of_litematic({region});
  CHECK(read.box == VoxelBox{{9, -20, 28}, {11, -18, 31}});
  // The array begins at the lowest corner all the same.
  CHECK(read.blocks.at({10, -20, 28}) == "minecraft:oak_stairs[facing=north,half=bottom]");
  CHECK(read.blocks.at({10, -19, 30}) == "minecraft:stone");
}

TEST_CASE("regions of Litematica are read one by one", "[formats]") {
  LitematicRegionFields second = region_sample();
  second.name = "second";
  second.position = {100, 0, 0};
  second.palette[3].name = "mod:other";
  const ForeignCells read = cells_of_litematic({region_sample(), second});
  CHECK(read.box == VoxelBox{{0, 0, 0}, {102, 2, 3}});
  CHECK(read.pieces == 2);
  CHECK(read.blocks.at({1, 0, 1}) == "minecraft:stone");
  CHECK(read.blocks.at({101, 0, 1}) == "mod:other");
}

TEST_CASE("packed numbers cross from long to long in every width", "[formats]") {
  SplitMix64 random(1);
  for (unsigned bits = 2; bits <= 16; ++bits) {
    CAPTURE(bits);
    LitematicRegionFields region;
    region.position = {-70, -3, -130};
    region.size = {75, 5, 70};
    const std::uint32_t count = bits == 16 ? 65'534 : (1u << bits) - (bits > 2 ? 1 : 0);
    for (std::uint32_t i = 0; i < count; ++i)
      region.palette.push_back({"m:" + std::to_string(i), {}});
    std::vector<std::uint32_t> numbers(75 * 5 * 70);
    for (auto& number : numbers) number = random.below(count);
    region.longs = packed_longs(numbers, bits);
    const ForeignCells read = cells_of_litematic({region});
    REQUIRE(read.blocks.size() == numbers.size());
    CHECK(read.pieces == 3 * 2 * 3);  // cut at x -64, 0; y 0; z -128, -64
    std::size_t wrong = 0;
    for (const auto& [at, block] : read.blocks) {
      const auto i = static_cast<std::size_t>(((at.y + 3) * 70 + at.z + 130) * 75 + at.x + 70);
      wrong += block != "m:" + std::to_string(numbers[i]) ? 1u : 0u;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("every truncation of a litematic is rejected", "[formats]") {
  const Bytes plain = litematic_plain({region_sample(), region_sample()});
  for (const Bytes& file : {plain, gzip_of(plain)}) {
    for (std::size_t size = 0; size < file.size(); ++size) {
      CAPTURE(size);
      const Bytes cut(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(size));
      CHECK(litematic_error(cut).code == ErrorCode::truncated);
    }
  }
}

TEST_CASE("the fields of a region have to agree", "[formats]") {
  const auto error_of = [](auto change) {
    LitematicRegionFields region = region_sample();
    change(region);
    return litematic_error(litematic_plain({region})).code;
  };
  CHECK(error_of([](auto& r) { r.longs.push_back(0); }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.longs.clear(); }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.size.y = 0; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.size.y = INT32_MIN; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.size = {1 << 20, 1 << 20, 1 << 20}; }) ==
        ErrorCode::limit_exceeded);
  CHECK(error_of([](auto& r) { r.position.z = INT32_MAX; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.position.z = INT32_MIN; }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.palette.clear(); }) == ErrorCode::bad_value);
  CHECK(error_of([](auto& r) { r.palette.pop_back(); }) == ErrorCode::bad_value);
  CHECK(litematic_error(litematic_plain({})).code == ErrorCode::bad_value);
  CHECK(litematic_error(litematic_plain({region_sample()}, 0)).code == ErrorCode::bad_version);
  CHECK(litematic_error(litematic_plain({region_sample()}, 8)).code == ErrorCode::bad_version);
  const std::vector<LitematicRegionFields> many(4097, region_sample());
  CHECK(litematic_error(litematic_plain(many)).code == ErrorCode::limit_exceeded);
}

TEST_CASE("names of a litematic take 24 MiB at most", "[formats]") {
  LitematicRegionFields region = region_sample();
  for (int i = 0; i < 500; ++i) region.palette.push_back({std::string(60'000, 'a'), {}});
  CHECK(litematic_error(gzip_of(litematic_plain({region}))).code == ErrorCode::limit_exceeded);
  region = region_sample();
  for (int i = 0; i < 500; ++i)
    region.palette[0].properties.emplace_back(std::string(60'000, 'a'), "");
  CHECK(litematic_error(gzip_of(litematic_plain({region}))).code == ErrorCode::limit_exceeded);
}

TEST_CASE("flipped bytes of a litematic give an error or sound pieces", "[formats]") {
  const Bytes plain = litematic_plain({region_sample()});
  int rejected = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) {
    for (const int mask : {1, 0x80, 0xff}) {
      Bytes flipped = plain;
      flipped[i] = static_cast<std::uint8_t>(flipped[i] ^ mask);
      rejected += static_cast<int>(!read_foreign_cells(read_litematic, flipped));
    }
  }
  CHECK(rejected > 0);
}
