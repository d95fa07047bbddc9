// LitChunk: a world chunk with what other programs send along: its light. ByteWorld: chunks of one world that
// lie side by side.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"
#include "tests/bench/app/bench_options.hpp"

namespace runstone::bench {

inline constexpr unsigned kByteEdge = 32;  // of the chunks: eight blocks of 16^3 each

struct LitChunk {
  RunChunk runs;                 // in the cheapest order, as a holder keeps it
  std::vector<Material> voxels;  // x fastest, then y, then z
  std::vector<std::uint8_t>
      light;  // at the same index, as Luanti keeps it: low nibble by day, high at night
};

struct ByteWorld {
  std::string name;
  std::vector<LitChunk> chunks;
};

/// noise_terrain (the server's own terrain, seed 7, cut like the whole Luanti world), and those of
/// measured_world_names().
std::vector<std::string> byte_world_names();

/// Luanti: every chunk that fits into its bounds, plants and torches kept, with the light that the game
/// computed. Scenarios: the chunk in the middle of each. Others: 320 x 160 x 320 or 128^3 voxels around the
/// ground. Their light is plain sunlight: 15 in every voxel that has none but empty ones above it, else 0; it does
/// not spread. Requires a known name.
Result<ByteWorld, std::string> byte_world(const std::string& name,
                                          const std::string& luanti_folder);

}  // namespace runstone::bench
