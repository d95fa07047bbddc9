#include "server/map/ground_index.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "common/core/hash.hpp"

using namespace runstone;

TEST_CASE("the index gives each tile and column the greatest version below it", "[map]") {
  SplitMix64 rng{Catch::rngSeed()};
  GroundIndex index;
  std::map<ChunkCoord, Version> chunks;
  for (Sequence seq = 0; seq < 400; ++seq) {
    const ChunkCoord at{rng.between(-20, 20), rng.between(-5, 5), rng.between(-20, 20)};
    const Version version = seq < 50 ? Version{} : Version{static_cast<Epoch>(1 + seq / 100), seq};
    index.add(at, version);
    chunks[at] = std::max(chunks[at], version);
  }
  std::map<ChunkKey, Version> versions;
  std::map<ColumnKey, Version> columns;
  std::map<ColumnKey, std::set<std::int32_t>> heights;
  for (const auto& [at, version] : chunks) {
    for (std::uint8_t level = 0; level <= kMapZoomMax; ++level) {
      const ChunkKey key = tile_of(at, level);
      versions[key] = std::max(versions[key], version);
      columns[column_of(key)] = std::max(columns[column_of(key)], version);
      heights[column_of(key)].insert(key.at.y);
    }
  }
  CAPTURE(Catch::rngSeed());
  for (const auto& [key, version] : versions) REQUIRE(index.version(key) == version);
  for (const auto& [key, version] : columns) REQUIRE(index.column_version(key) == version);
  for (const auto& [key, all] : heights)
    REQUIRE(index.heights(key) == std::vector<std::int32_t>(all.rbegin(), all.rend()));
  CHECK_FALSE(index.version({0, {99, 0, 0}}).has_value());
  CHECK(index.column_version({0, 99, 0}) == Version{});
  CHECK(index.heights({0, 99, 0}).empty());
}

TEST_CASE("the bounds hold every chunk, also those of one version", "[map]") {
  GroundIndex index;
  CHECK_FALSE(index.bounds().has_value());
  index.add({3, -2, 5}, {});
  index.add({-4, 0, 5}, {});
  index.add({2, 1, -6}, {});
  CHECK(index.bounds() == VoxelBox{{-4, -2, -6}, {4, 2, 6}});
}
