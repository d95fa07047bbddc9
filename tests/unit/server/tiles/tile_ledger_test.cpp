#include "server/tiles/tile_ledger.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <vector>

#include "common/core/hash.hpp"
#include "common/core/tile_keys.hpp"

using namespace runstone;

namespace {

/// A model of the ledger: the newest edit of each chunk and tile, and which of them have ground.
struct LedgerModel {
  void edited(const std::vector<ChunkCoord>& chunks, Sequence seq) {
    for (const ChunkCoord& chunk : chunks) {
      for (std::uint8_t level = 0; level <= kTileLevelMax; ++level)
        newest[tile_of(chunk, level)] = std::max(newest[tile_of(chunk, level)], seq);
    }
  }
  void stored(ChunkCoord chunk, Sequence seq) {
    for (std::uint8_t level = 0; level <= kTileLevelMax; ++level) {
      Sequence& known = newest[tile_of(chunk, level)];
      known = std::max(known, seq);
    }
  }
  std::map<ChunkKey, Sequence> newest;
};

ChunkCoord random_chunk_at(SplitMix64& random) {
  return {random.between(-40, 40), random.between(-4, 4), random.between(-40, 40)};
}

}  // namespace

TEST_CASE("a new ledger knows no edit and no ground", "[tiles]") {
  const TileLedger ledger;
  CHECK(ledger.newest_edit({1, {0, 0, 0}}) == 0);
  CHECK_FALSE(ledger.is_stored_or_edited({8, {0, 0, 0}}));
}

TEST_CASE("a ledger knows the newest edit and the ground of each tile", "[tiles]") {
  SplitMix64 random(Catch::rngSeed());
  TileLedger ledger;
  LedgerModel model;
  std::vector<std::pair<ChunkKey, Version>> stored;
  stored.push_back({{3, {100, 100, 100}}, {}});  // of a tile: no ground
  for (int i = 0; i < 600; ++i) {
    const ChunkCoord chunk = random_chunk_at(random);
    const Sequence seq = random.below(400);
    stored.push_back({{0, chunk}, seq == 0 ? Version{} : Version{1, seq}});
    if (i >= 300) continue;
    model.stored(chunk, seq);
  }
  ledger.stored(std::span(stored).first(301));
  for (Sequence seq = 1; seq <= 500; ++seq) {
    std::vector<ChunkCoord> chunks;
    const ChunkCoord first = random_chunk_at(random);
    for (std::int32_t i = 0; i < random.between(1, 9); ++i)
      chunks.push_back({first.x + i % 3, first.y, first.z + i / 3});
    ledger.edited(chunks, seq);
    model.edited(chunks, seq);
    if (seq == 250) {  // edits may come before the stored chunks are known
      ledger.stored(stored);
      for (const auto& [key, version] : stored) {
        if (key.lod == 0) model.stored(key.at, version.seq);
      }
    }
  }
  for (std::uint8_t level = 0; level <= kTileLevelMax; ++level) {
    for (std::int32_t x = -48 >> level; x <= 48 >> level; ++x) {
      for (std::int32_t y = -6 >> level; y <= 6 >> level; ++y) {
        for (std::int32_t z = -48 >> level; z <= 48 >> level; ++z) {
          const ChunkKey key{level, {x, y, z}};
          const auto known = model.newest.find(key);
          REQUIRE(ledger.is_stored_or_edited(key) == (known != model.newest.end()));
          REQUIRE(ledger.newest_edit(key) == (known == model.newest.end() ? 0 : known->second));
        }
      }
    }
  }
}
