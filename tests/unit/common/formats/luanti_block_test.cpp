#include "common/formats/luanti_block.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <map>

#include "common/core/hash.hpp"
#include "common/formats/block_assembler.hpp"
#include "tests/support/formats/luanti_bytes.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Three materials at simple places, so that a wrong axis or byte order shows.
LuantiBlockFields sample() {
  LuantiBlockFields fields;
  fields.names = {{7, "air"}, {300, "default:stone"}, {2, "default:dirt"}};
  fields.nodes.assign(4096, 7);
  fields.nodes[0] = 300;                    // x 0, y 0, z 0
  fields.nodes[1] = 2;                      // x 1
  fields.nodes[16 * 3] = 300;               // y 3
  fields.nodes[256 * 5 + 16 * 2 + 15] = 2;  // x 15, y 2, z 5
  return fields;
}

std::string name_at(const ForeignPiece& block, LocalPos at) {
  const Material material = material_at(block.voxels, at);
  return material == kEmpty ? "" : block.blocks[material - 1u].name;
}

ErrorCode code_of(ByteView row) {
  const auto block = decode_luanti_block(row);
  REQUIRE_FALSE(block.has_value());
  return block.error().code;
}

void check_sound(const ForeignPiece& block) {
  REQUIRE(validate(block.voxels).has_value());
  for (std::size_t i = 0; i < block.voxels.runs.size(); ++i) {
    REQUIRE(block.voxels.runs.material(i) <= block.blocks.size());
  }
}

}  // namespace

TEST_CASE("a block's nodes are decoded at their places", "[formats]") {
  const auto block = decode_luanti_block(luanti_row(sample()));
  REQUIRE(block.has_value());
  check_sound(*block);
  CHECK(block->blocks ==
        std::vector<ForeignBlock>{{"air", ""}, {"default:stone", ""}, {"default:dirt", ""}});
  CHECK(block->voxels.order == AxisOrder::xyz);
  CHECK(block->voxels.runs.size() == 7);
  CHECK(name_at(*block, {0, 0, 0}) == "default:stone");
  CHECK(name_at(*block, {1, 0, 0}) == "default:dirt");
  CHECK(name_at(*block, {2, 0, 0}) == "air");
  CHECK(name_at(*block, {0, 3, 0}) == "default:stone");
  CHECK(name_at(*block, {15, 2, 5}) == "default:dirt");
  CHECK(name_at(*block, {15, 15, 15}) == "air");
}

TEST_CASE("a block that the game wrote decodes to its known contents", "[formats][golden]") {
  std::ifstream in(
      std::string(RUNSTONE_SOURCE_DIR) + "/tests/fuzz/corpus/luanti_block_fuzz/game_written",
      std::ios::binary);
  REQUIRE(in.good());
  const Bytes row{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  const auto block = decode_luanti_block(row);
  REQUIRE(block.has_value());
  check_sound(*block);
  const std::vector<std::string> nodes = luanti_nodes(row);
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const LocalPos at{static_cast<std::uint8_t>(i % 16), static_cast<std::uint8_t>(i / 16 % 16),
                      static_cast<std::uint8_t>(i / 256)};
    REQUIRE(name_at(*block, at) == nodes[i]);
  }
  // The pinned digest is of the names alone: materials of one name are the same material.
  std::map<std::string, Material> first_of_name;
  std::vector<Material> by_name{kEmpty};
  std::map<std::string, int> states;
  for (std::size_t i = 0; i < block->blocks.size(); ++i) {
    const auto id = static_cast<Material>(i + 1);
    by_name.push_back(first_of_name.try_emplace(block->blocks[i].name, id).first->second);
  }
  CHECK(to_hex(digest_of(with_materials(block->voxels, by_name))) ==
        "0481e14fc178484e13c9df2eeae9a9dd");
  for (std::size_t i = 0; i < block->voxels.runs.size(); ++i) {
    const ForeignBlock& node = block->blocks[block->voxels.runs.material(i) - 1u];
    if (!node.states.empty()) {
      states[node.name + " " + node.states] +=
          static_cast<int>(block->voxels.runs.end(i) - block->voxels.runs.begin(i));
    }
  }
  CHECK(states == std::map<std::string, int>{{"default:chest param2=2", 1},
                                             {"stairs:stair_cobble param2=3", 8}});
}

TEST_CASE("random blocks decode node by node", "[formats]") {
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 30; ++round) {
    LuantiBlockFields fields;
    const std::uint32_t names = 1 + random.below(round % 5 == 0 ? 4096 : 12);
    const auto first_id = static_cast<std::uint16_t>(random.below(61440));
    for (std::uint32_t i = 0; i < names; ++i) {
      fields.names.emplace_back(static_cast<std::uint16_t>(first_id + i),
                                "mod:node_" + std::to_string(i));
    }
    std::uint32_t left = 0;
    std::uint16_t id = 0;
    for (auto& node : fields.nodes) {
      if (left == 0) {
        left = 1 + random.below(40);
        id = static_cast<std::uint16_t>(first_id + random.below(names));
      }
      node = id;
      --left;
    }
    const auto block = decode_luanti_block(luanti_row(fields));
    REQUIRE(block.has_value());
    check_sound(*block);
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const LocalPos at{static_cast<std::uint8_t>(i % 16), static_cast<std::uint8_t>(i / 16 % 16),
                        static_cast<std::uint8_t>(i / 256)};
      REQUIRE(name_at(*block, at) == "mod:node_" + std::to_string(fields.nodes[i] - first_id));
    }
  }
}

TEST_CASE("ignore nodes become material 0", "[formats]") {
  LuantiBlockFields fields = sample();
  fields.names[2].second = "ignore";
  const auto block = decode_luanti_block(luanti_row(fields));
  REQUIRE(block.has_value());
  CHECK(material_at(block->voxels, {1, 0, 0}) == kEmpty);
  CHECK(name_at(*block, {0, 0, 0}) == "default:stone");
}

TEST_CASE("the second parameter of a node is its state", "[formats]") {
  LuantiBlockFields fields = sample();
  fields.param2.assign(4096, 0);
  fields.param2[0] = 3;         // stone
  fields.param2[16 * 3] = 255;  // stone
  fields.param2[2] = 3;         // air
  fields.names[2].second = "ignore";
  fields.param2[1] = 3;  // ignore
  const auto block = decode_luanti_block(luanti_row(fields));
  REQUIRE(block.has_value());
  check_sound(*block);
  const auto node_at = [&](LocalPos at) {
    return block->blocks[material_at(block->voxels, at) - 1u];
  };
  CHECK(node_at({0, 0, 0}) == ForeignBlock{"default:stone", "param2=3"});
  CHECK(node_at({0, 3, 0}) == ForeignBlock{"default:stone", "param2=255"});
  CHECK(node_at({2, 0, 0}) == ForeignBlock{"air", "param2=3"});
  CHECK(node_at({3, 0, 0}) == ForeignBlock{"air", ""});
  CHECK(material_at(block->voxels, {1, 0, 0}) == kEmpty);
  CHECK(block->blocks.size() == 6);
}

TEST_CASE("long names with many states are rejected", "[formats]") {
  LuantiBlockFields fields;
  fields.names = {{0, std::string(60'000, 'a')}};
  for (std::size_t i = 0; i < fields.param2.size(); ++i)
    fields.param2[i] = static_cast<std::uint8_t>(i);
  CHECK(code_of(luanti_row(fields)) == ErrorCode::limit_exceeded);
  fields.names = {{0, std::string(4'000, 'a')}};
  CHECK(decode_luanti_block(luanti_row(fields)).has_value());
}

TEST_CASE("two ids with one name are both decoded", "[formats]") {
  LuantiBlockFields fields = sample();
  fields.names[2].second = "default:stone";
  const auto block = decode_luanti_block(luanti_row(fields));
  REQUIRE(block.has_value());
  CHECK(name_at(*block, {1, 0, 0}) == "default:stone");
}

TEST_CASE("every truncation of a block is rejected", "[formats]") {
  const Bytes row = luanti_row(sample());
  for (std::size_t size = 0; size < row.size(); ++size) {
    CAPTURE(size, row.size());
    const auto block = decode_luanti_block(ByteView(row).first(size));
    REQUIRE_FALSE(block.has_value());
    CHECK(block.error().code == ErrorCode::truncated);
  }
}

TEST_CASE("every truncation inside the stream is rejected up to the end of the nodes",
          "[formats]") {
  const Bytes plain = luanti_plain(sample());
  const std::size_t needed = plain.size() - sample().rest.size();
  for (std::size_t size = 0; size < plain.size(); size += size < 64 ? 1 : 61) {
    const auto block = decode_luanti_block(
        luanti_row(Bytes(plain.begin(), plain.begin() + static_cast<std::ptrdiff_t>(size))));
    CAPTURE(size, needed);
    REQUIRE(block.has_value() == (size >= needed));
    if (!block) CHECK(block.error().code == ErrorCode::truncated);
  }
}

TEST_CASE("bytes behind the stream are ignored, as in Luanti", "[formats]") {
  const auto alone = decode_luanti_block(luanti_row(sample()));
  Bytes row = luanti_row(sample());
  SECTION("three bytes") { row.insert(row.end(), 3, 0); }
  SECTION("another frame") {
    const Bytes other = luanti_row(Bytes{'x'});
    row.insert(row.end(), other.begin() + 1, other.end());
  }
  const auto block = decode_luanti_block(row);
  REQUIRE(block.has_value());
  CHECK(block->voxels == alone->voxels);
  CHECK(block->blocks == alone->blocks);
}

TEST_CASE("blocks of the versions 24 to 28 have the nodes of version 29", "[formats]") {
  LuantiBlockFields fields = sample();
  fields.param2[0] = 3;
  const auto today = decode_luanti_block(luanti_row(fields));
  REQUIRE(today.has_value());
  for (std::uint8_t version = 24; version <= 28; ++version) {
    CAPTURE(int{version});
    for (const std::size_t metadata : {std::size_t{1}, std::size_t{5} << 20}) {
      const auto block =
          decode_luanti_block(luanti_old_row(fields, version, Bytes(metadata, 'm'), {10, 0, 0, 7}));
      REQUIRE(block.has_value());
      CHECK(block->voxels == today->voxels);
      CHECK(block->blocks == today->blocks);
    }
  }
}

TEST_CASE("every truncation of an old block is rejected up to the end of its names", "[formats]") {
  for (std::uint8_t version = 24; version <= 28; ++version) {
    const Bytes row = luanti_old_row(sample(), version, {0}, {});
    REQUIRE(decode_luanti_block(row).has_value());
    for (std::size_t size = 0; size < row.size(); ++size) {
      CAPTURE(int{version}, size, row.size());
      const auto block = decode_luanti_block(ByteView(row).first(size));
      REQUIRE_FALSE(block.has_value());
      CHECK(block.error().code == ErrorCode::truncated);
    }
  }
}

TEST_CASE("flipped bytes of an old block give an error or a valid block", "[formats]") {
  const Bytes row = luanti_old_row(sample(), 28);
  int rejected = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = row;
      flipped[i] = static_cast<std::uint8_t>(flipped[i] ^ (1 << bit));
      const auto block = decode_luanti_block(flipped);
      if (block) check_sound(*block);
      rejected += static_cast<int>(!block);
    }
  }
  CHECK(rejected > 0);
}

TEST_CASE("old blocks whose streams are too long are rejected", "[formats]") {
  CHECK(code_of(luanti_old_row(sample(), 28, Bytes((std::size_t{64} << 20) + 1))) ==
        ErrorCode::limit_exceeded);
  LuantiBlockFields fields = sample();
  fields.param2.push_back(0);
  CHECK(code_of(luanti_old_row(fields, 28)) == ErrorCode::limit_exceeded);
  fields.param2.resize(4095);
  CHECK(code_of(luanti_old_row(fields, 28)) == ErrorCode::truncated);
}

TEST_CASE("other versions of the format are rejected by name", "[formats]") {
  for (int version = 0; version < 256; ++version) {
    if (version >= 24 && version <= 29) continue;
    CHECK(code_of(luanti_row(luanti_plain(sample()), static_cast<std::uint8_t>(version))) ==
          ErrorCode::bad_version);
  }
  LuantiBlockFields fields = sample();
  fields.name_table_version = 1;
  CHECK(code_of(luanti_row(fields)) == ErrorCode::bad_version);
}

TEST_CASE("fields out of their range are rejected", "[formats]") {
  LuantiBlockFields fields = sample();
  SECTION("content width") { fields.content_width = 1; }
  SECTION("parameter width") { fields.params_width = 1; }
  SECTION("an id without a name") { fields.nodes[4095] = 8; }
  SECTION("an id with two names") { fields.names.emplace_back(std::uint16_t{300}, "default:sand"); }
  CHECK(code_of(luanti_row(fields)) == ErrorCode::bad_value);
}

TEST_CASE("a name table with more names than nodes is rejected", "[formats]") {
  LuantiBlockFields fields = sample();
  fields.names.clear();
  for (std::uint16_t i = 0; i < 4097; ++i) fields.names.emplace_back(i, "n");
  CHECK(code_of(luanti_row(fields)) == ErrorCode::limit_exceeded);
}

TEST_CASE("a block with megabytes of metadata behind its nodes keeps its nodes", "[formats]") {
  LuantiBlockFields fields = sample();
  const auto alone = decode_luanti_block(luanti_row(fields));
  fields.rest.assign(8 * kLuantiBlockBytesMax, 'm');
  const auto block = decode_luanti_block(luanti_row(fields));
  REQUIRE(block.has_value());
  CHECK(block->voxels == alone->voxels);
}

TEST_CASE("names that exceed the bound are rejected", "[formats]") {
  LuantiBlockFields fields = sample();
  for (std::uint16_t i = 0; i < 20; ++i)
    fields.names.emplace_back(static_cast<std::uint16_t>(400 + i), std::string(60'000, 'a'));
  const Bytes bomb = luanti_row(fields);
  CHECK(bomb.size() < 4096);
  CHECK(code_of(bomb) == ErrorCode::limit_exceeded);
  CHECK(code_of(luanti_old_row(fields, 28)) == ErrorCode::limit_exceeded);
}

TEST_CASE("flipped bytes give an error or a valid block", "[formats]") {
  const Bytes row = luanti_row(sample());
  int rejected = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    for (int bit = 0; bit < 8; ++bit) {
      Bytes flipped = row;
      flipped[i] = static_cast<std::uint8_t>(flipped[i] ^ (1 << bit));
      const auto block = decode_luanti_block(flipped);
      if (block) check_sound(*block);
      rejected += static_cast<int>(!block);
    }
  }
  CHECK(rejected > 0);
  // Bits inside the stream are flipped too, where no checksum of the outer format helps.
  const Bytes plain = luanti_plain(sample());
  for (std::size_t i = 0; i < 64; ++i) {
    Bytes flipped = plain;
    flipped[i] = static_cast<std::uint8_t>(~flipped[i]);
    const auto block = decode_luanti_block(luanti_row(flipped));
    if (block) check_sound(*block);
  }
}

TEST_CASE("a row's key and its block coordinates are each other's inverse", "[formats]") {
  CHECK(luanti_block_coord(0) == ChunkCoord{0, 0, 0});
  CHECK(luanti_block_coord(1) == ChunkCoord{1, 0, 0});
  CHECK(luanti_block_coord(-1) == ChunkCoord{-1, 0, 0});
  CHECK(luanti_block_coord(-4096 * 4096 + 4096 * 2 - 3) == ChunkCoord{-3, 2, -1});
  CHECK(luanti_block_pos({-3, 2, -1}) == -4096 * 4096 + 4096 * 2 - 3);
  SplitMix64 random(Catch::rngSeed());
  for (int i = 0; i < 1000; ++i) {
    const ChunkCoord at{random.between(-2048, 2047), random.between(-2048, 2047),
                        random.between(-2048, 2047)};
    REQUIRE(luanti_block_coord(luanti_block_pos(at)) == at);
  }
  for (const std::int64_t wild : {INT64_MAX, INT64_MIN, std::int64_t{1} << 36}) {
    CHECK(luanti_block_pos(luanti_block_coord(wild)) != wild);
  }
}
