#include "common/formats/block_assembler.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

using Blocks = std::map<ChunkCoord, RunChunk>;

Blocks random_blocks(SplitMix64& random, std::int32_t edge, ChunkCoord at) {
  Blocks blocks;
  const std::int32_t side = edge / 16;
  for (std::int32_t i = 0; i < side * side * side; ++i) {
    if (random.below(4) == 0) continue;
    const ChunkCoord block{at.x * side + i % side, at.y * side + i / side % side,
                           at.z * side + i / side / side};
    const auto shape = static_cast<ChunkShape>(random.below(kShapeCount));
    blocks.emplace(
        block, random_chunk(random, Extent::cube(16), AxisOrder::xyz, 1 + random.below(20), shape));
  }
  return blocks;
}

RunChunk assemble(const Blocks& blocks, std::int32_t edge, ChunkCoord at) {
  return assemble_chunk(edge, at, [&](ChunkCoord block) {
    const auto found = blocks.find(block);
    return found == blocks.end() ? nullptr : &found->second;
  });
}

/// Returns the same chunk, copied voxel by voxel.
DenseChunk assemble_dense(const Blocks& blocks, std::int32_t edge, ChunkCoord at) {
  DenseChunk out(Extent::cube(static_cast<unsigned>(edge)));
  for (const auto& [block, voxels] : blocks) {
    const DenseChunk source = DenseChunk::of(voxels);
    for (int z = 0; z < 16; ++z) {
      for (int y = 0; y < 16; ++y) {
        for (int x = 0; x < 16; ++x) {
          out.set(block.x * 16 - at.x * edge + x, block.y * 16 - at.y * edge + y,
                  block.z * 16 - at.z * edge + z, source.at(x, y, z));
        }
      }
    }
  }
  return out;
}

}  // namespace

TEST_CASE("blocks assembled run by run equal blocks copied voxel by voxel", "[formats][property]") {
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 60; ++round) {
    const std::int32_t edge = round == 0 ? 128 : 16 << random.below(3);
    const ChunkCoord at{random.between(-20, 20), random.between(-20, 20), random.between(-20, 20)};
    const Blocks blocks = random_blocks(random, edge, at);
    const RunChunk chunk = assemble(blocks, edge, at);
    CAPTURE(round, edge);
    REQUIRE(validate(chunk).has_value());
    REQUIRE(chunk.order == AxisOrder::xyz);
    REQUIRE(DenseChunk::of(chunk) == assemble_dense(blocks, edge, at));
  }
}

TEST_CASE("the voxel copy detects one wrong block", "[formats][property]") {
  SplitMix64 random(3);
  const ChunkCoord at{1, -2, 3};
  Blocks blocks = random_blocks(random, 32, at);
  blocks.insert_or_assign({2, -4, 6}, uniform_chunk(Extent::cube(16), 5));
  const DenseChunk before = assemble_dense(blocks, 32, at);
  REQUIRE(fill(blocks.at({2, -4, 6}), 4095, 1, 6));
  CHECK_FALSE(DenseChunk::of(assemble(blocks, 32, at)) == before);
}

TEST_CASE("equal blocks make a single run, and no blocks an empty chunk", "[formats]") {
  const RunChunk rock = uniform_chunk(Extent::cube(16), 9);
  CHECK(assemble_chunk(64, {0, 0, 0}, [&](ChunkCoord) { return &rock; }) ==
        uniform_chunk(Extent::cube(64), 9));
  CHECK(assemble_chunk(32, {0, 0, 0}, [](ChunkCoord) -> const RunChunk* { return nullptr; }) ==
        uniform_chunk(Extent::cube(32), kEmpty));
}

TEST_CASE("materials are replaced run by run and equal neighbours merge", "[formats][property]") {
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 100; ++round) {
    const RunChunk chunk =
        random_chunk(random, random_extent(random, 24), random_order(random), 12);
    std::vector<Material> to(kMaterialCountMax);
    for (Material& material : to) material = static_cast<Material>(random.below(5));
    const RunChunk mapped = with_materials(chunk, to);
    REQUIRE(validate(mapped).has_value());
    const DenseChunk before = DenseChunk::of(chunk);
    DenseChunk expected = before;
    for (int z = 0; z < before.side_z(); ++z) {
      for (int y = 0; y < before.side_y(); ++y) {
        for (int x = 0; x < before.side_x(); ++x) expected.set(x, y, z, to[before.at(x, y, z)]);
      }
    }
    REQUIRE(DenseChunk::of(mapped) == expected);
  }
}
