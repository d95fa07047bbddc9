// Tile keys: how the keys of tiles and chunks contain each other. A tile of level L covers 2 x 2 x
// 2 tiles of level L - 1; those of level 0 are the chunks. So it covers 2^L chunks along each axis.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"

namespace runstone {

/// The highest level of detail. Levels 1 .. kTileLevelMax are tiles. A tile of it is 256 chunks
/// wide. kWorldLimit is a multiple of that width for every chunk edge, so no tile crosses the
/// border of the world.
inline constexpr std::uint8_t kTileLevelMax = 8;
/// The children of a tile.
inline constexpr unsigned kTileChildren = 8;

/// Returns the coordinate of the tile of level `level` that covers the chunk.
constexpr ChunkCoord tile_at(ChunkCoord chunk, std::uint8_t level) {
  return {chunk.x >> level, chunk.y >> level, chunk.z >> level};
}

/// Returns the tile of level `level` that covers the chunk. At level 0 it is the chunk.
constexpr ChunkKey tile_of(ChunkCoord chunk, std::uint8_t level) {
  return {level, tile_at(chunk, level)};
}

/// Returns the tile of the next level that covers this tile or chunk.
constexpr ChunkKey tile_parent(const ChunkKey& key) {
  return {static_cast<std::uint8_t>(key.lod + 1), tile_at(key.at, 1)};
}

/// Returns a child of a tile. Child i lies at x = i & 1, y = i >> 1 & 1, z = i >> 2. Requires level
/// 1 or more.
constexpr ChunkKey tile_child(const ChunkKey& key, unsigned i) {
  const auto bit = [i](unsigned n) { return static_cast<std::int32_t>(i >> n & 1U); };
  return {static_cast<std::uint8_t>(key.lod - 1),
          {2 * key.at.x + bit(0), 2 * key.at.y + bit(1), 2 * key.at.z + bit(2)}};
}

/// Returns which child of its parent a tile or chunk is.
constexpr unsigned child_index(const ChunkKey& key) {
  return static_cast<unsigned>((key.at.x & 1) | (key.at.y & 1) << 1 | (key.at.z & 1) << 2);
}

/// Returns the first voxel of a tile or chunk. `edge` is that of a chunk.
constexpr VoxelPos tile_origin(const ChunkKey& key, std::int32_t edge) {
  const std::int32_t width = edge << key.lod;
  return {key.at.x * width, key.at.y * width, key.at.z * width};
}

/// Returns the first chunk that a tile covers.
constexpr ChunkCoord first_chunk(const ChunkKey& key) {
  const std::int32_t side = 1 << key.lod;
  return {key.at.x * side, key.at.y * side, key.at.z * side};
}

}  // namespace runstone
