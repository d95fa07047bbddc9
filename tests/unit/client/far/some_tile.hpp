// Tiles for tests.
#pragma once
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

inline constexpr std::int32_t kTileEdge = 16;

/// Returns a random tile of more than one material.
inline RunChunk some_tile(SplitMix64& rng) {
  RunChunk out;
  do {
    out = random_chunk(rng, Extent::cube(kTileEdge), random_order(rng), 4);
  } while (out.is_uniform());
  return out;
}

}  // namespace runstone::test
