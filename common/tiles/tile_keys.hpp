// Keys of tiles: which tile lies above which. A tile of level L covers 2 x 2 x 2 chunks or tiles of
// level L - 1, which are its children. Level 0 is the chunks themselves.
#pragma once
#include <cstdint>

#include "common/core/coords.hpp"

namespace runstone {

/// The highest level. A tile of it is 256 chunks wide. kWorldLimit is a multiple of that width for
/// every chunk edge, so a tile never crosses the border of the world.
inline constexpr std::uint8_t kTileLevelMax = 8;

/// Returns the tile that contains a chunk or a tile, one level above it.
constexpr ChunkKey tile_parent(const ChunkKey& key) {
  return {static_cast<std::uint8_t>(key.lod + 1),
          {key.at.x >> 1, key.at.y >> 1, key.at.z >> 1}};  // in C++20 >> rounds down
}

/// Returns a child of a tile. The index is that of TileChildren: x = index & 1, y = index >> 1 & 1,
/// z = index >> 2. Requires level 1 or more and index < 8.
constexpr ChunkKey tile_child(const ChunkKey& tile, unsigned index) {
  return {static_cast<std::uint8_t>(tile.lod - 1),
          {2 * tile.at.x + static_cast<std::int32_t>(index & 1U),
           2 * tile.at.y + static_cast<std::int32_t>(index >> 1U & 1U),
           2 * tile.at.z + static_cast<std::int32_t>(index >> 2U)}};
}

/// Returns the tile of a level that contains a chunk, or the chunk itself for level 0. Requires
/// level <= kTileLevelMax.
constexpr ChunkKey tile_of(ChunkCoord chunk, std::uint8_t level) {
  return {level, {chunk.x >> level, chunk.y >> level, chunk.z >> level}};
}

/// Returns the first voxel of a tile. `edge` is that of a chunk.
constexpr VoxelPos tile_origin(const ChunkKey& tile, std::int32_t edge) {
  const std::int32_t width = edge << tile.lod;
  return {tile.at.x * width, tile.at.y * width, tile.at.z * width};
}

}  // namespace runstone
