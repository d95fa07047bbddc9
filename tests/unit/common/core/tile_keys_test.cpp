#include "common/core/tile_keys.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("the tile of a chunk is found by division that rounds down", "[tiles]") {
  CHECK(tile_of({5, -1, 0}, 0) == ChunkKey{0, {5, -1, 0}});
  CHECK(tile_of({5, -1, 0}, 1) == ChunkKey{1, {2, -1, 0}});
  CHECK(tile_of({255, -256, -257}, 8) == ChunkKey{8, {0, -1, -2}});
  CHECK(tile_parent({0, {-1, -2, -3}}) == ChunkKey{1, {-1, -1, -2}});
}

TEST_CASE("a tile has eight children, whose parent it is", "[tiles]") {
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 100; ++round) {
    const ChunkKey tile{static_cast<std::uint8_t>(random.between(1, kTileLevelMax)),
                        {random.between(-9, 9), random.between(-9, 9), random.between(-9, 9)}};
    for (unsigned i = 0; i < 8; ++i) {
      const ChunkKey child = tile_child(tile, i);
      CHECK(tile_parent(child) == tile);
      CHECK(child_index(child) == i);
      CHECK(child.at.x - 2 * tile.at.x == static_cast<int>(i & 1U));
      CHECK(child.at.y - 2 * tile.at.y == static_cast<int>(i >> 1U & 1U));
      CHECK(child.at.z - 2 * tile.at.z == static_cast<int>(i >> 2U));
    }
  }
}

TEST_CASE("the tile of a chunk is its parent of parents", "[tiles]") {
  SplitMix64 random(Catch::rngSeed());
  const std::int32_t last = kWorldLimit / 16;
  for (int round = 0; round < 100; ++round) {
    const ChunkCoord chunk{random.between(-last, last - 1), random.between(-last, last - 1),
                           random.between(-300, 300)};
    ChunkKey key{0, chunk};
    for (std::uint8_t level = 0; level <= kTileLevelMax; ++level) {
      CHECK(tile_of(chunk, level) == key);
      CHECK(key.lod == level);
      key = tile_parent(key);
    }
  }
}

TEST_CASE("a tile begins at the first voxel of its first chunk", "[tiles]") {
  CHECK(first_chunk({3, {1, -2, 3}}) == ChunkCoord{8, -16, 24});
  CHECK(tile_origin({0, {1, -2, 3}}, 32) == VoxelPos{32, -64, 96});
  CHECK(tile_origin({3, {1, -2, 3}}, 32) == VoxelPos{256, -512, 768});
  CHECK(tile_origin({8, {-kWorldLimit / (128 << 8), 0, 0}}, 128).x == -kWorldLimit);
}
