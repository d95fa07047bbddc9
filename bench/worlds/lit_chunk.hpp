// LitChunk: a world chunk with its light, which other programs send along. ByteWorld: chunks of one
// world that lie side by side.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone::bench {

inline constexpr unsigned kByteEdge = 32;  // edge of the chunks: eight blocks of 16^3 each

struct LitChunk {
  RunChunk runs;                 // in the cheapest axis order, as a holder keeps it
  std::vector<Material> voxels;  // x fastest, then y, then z
  // The light at the same index, as Luanti keeps it: low nibble by day, high nibble at night.
  std::vector<std::uint8_t> light;
};

struct ByteWorld {
  std::string name;
  std::vector<LitChunk> chunks;
};

/// Returns noise_terrain (the server's terrain, seed 7, cut like the whole Luanti world) and the
/// names of measured_world_names().
std::vector<std::string> byte_world_names();

/// Returns the chunks of a world:
/// - Luanti: every chunk inside its bounds, plants and torches kept, with the light that the game
///   computed;
/// - scenarios: the chunk in the middle of each;
/// - others: 320 x 160 x 320 or 128^3 voxels around the ground.
/// The worlds without a game have plain sunlight: 15 in an empty voxel with only empty voxels above
/// it, else 0. Their light does not spread. Requires a known name.
Result<ByteWorld, std::string> byte_world(const std::string& name,
                                          const std::string& luanti_folder);

}  // namespace runstone::bench
