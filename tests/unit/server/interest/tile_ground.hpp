// A world of tiles for tests of TileInterest.
#pragma once
#include <optional>
#include <set>

#include "common/core/hash.hpp"
#include "server/interest/tile_interest.hpp"

namespace runstone::test {

constexpr CoordLimit kTileWorld{1 << 20};

/// A world in which some tiles have ground. All tiles above one of them have ground, too.
struct TileGround {
  std::set<ChunkKey> solid;  // tiles that are not empty
  explicit TileGround(int chunks = 400) {
    SplitMix64 rng(7);
    for (int n = 0; n < chunks; ++n) {
      const ChunkCoord at{rng.between(-40, 40), rng.between(-6, 6), rng.between(-40, 40)};
      for (std::uint8_t level = 1; level <= kTileLevelMax; ++level)
        solid.insert(tile_of(at, level));
    }
  }
  bool is_empty(const ChunkKey& key) const { return !solid.contains(key); }
};

inline std::optional<ChunkKey> next_of(const TileInterest& tiles) {
  return tiles.next_wanted(1, [](const ChunkKey& /*key*/) { return true; });
}

}  // namespace runstone::test
