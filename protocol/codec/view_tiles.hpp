// View tiles: the tiles that a view contains. At each level 1 .. View::levels, it contains a disc
// of tiles around its centre whose radius in tiles is that of the view in chunks. So each level
// reaches twice as far as the one before. docs/protocol.md specifies it.
//
// A tile or chunk of a view has its parent in the view, too, up to the highest level. For chunks
// this holds up to 3 chunks above and below the centre. Proof for one axis: halving rounds each of
// two coordinates down, so a distance d becomes at most (d + 1) / 2. In the plane, a distance r
// becomes at most r / 2 + sqrt(2) / 2, which is at most r from r = 2 on.
#pragma once
#include <cstdint>

#include "common/core/tile_keys.hpp"
#include "protocol/codec/view_size.hpp"

namespace runstone {

/// The tiles of a level reach so many tiles above and below that of the centre.
inline constexpr std::int32_t kTileRadiusV = 2;
/// A view with a smaller horizontal radius contains no tiles.
inline constexpr std::uint8_t kTileRadiusHMin = 2;

/// Returns the highest level of the view's tiles, or 0 if it has none.
constexpr std::uint8_t tile_levels(const View& view) {
  return view.radius_h < kTileRadiusHMin ? std::uint8_t{0} : view.levels;
}

/// Returns true if the world has a place for this tile or chunk.
constexpr bool has_place(CoordLimit world, const ChunkKey& key) {
  return CoordLimit{world.limit >> key.lod}.contains(key.at);
}

/// Returns true if the view contains this chunk or tile.
inline bool contains_key(const View& view, const ChunkKey& key) {
  if (key.lod == 0) return view.contains(key.at);
  if (key.lod > tile_levels(view)) return false;
  const ChunkCoord centre = tile_at(view.centre, key.lod);
  const std::int64_t dx = std::int64_t{key.at.x} - centre.x;
  const std::int64_t dy = std::int64_t{key.at.y} - centre.y;
  const std::int64_t dz = std::int64_t{key.at.z} - centre.z;
  return dx * dx + dz * dz <= std::int64_t{view.radius_h} * view.radius_h && dy <= kTileRadiusV &&
         -dy <= kTileRadiusV;
}

/// Returns true if the view contains this chunk or tile and the world has it too.
inline bool has_key(const View& view, CoordLimit world, const ChunkKey& key) {
  return contains_key(view, key) && has_place(world, key);
}

/// Calls visit(key) for each tile of a level in the view, ascending, without those outside of the
/// world. Requires that the view has tiles of this level.
template <class Visit>
void for_each_tile(const View& view, CoordLimit world, std::uint8_t level, const Visit& visit) {
  const ChunkCoord centre = tile_at(view.centre, level);
  const std::int32_t radius = view.radius_h;
  for (std::int32_t dx = -radius; dx <= radius; ++dx) {
    for (std::int32_t dy = -kTileRadiusV; dy <= kTileRadiusV; ++dy) {
      for (std::int32_t dz = -radius; dz <= radius; ++dz) {
        if (dx * dx + dz * dz > radius * radius) continue;
        const ChunkKey key{level, {centre.x + dx, centre.y + dy, centre.z + dz}};
        if (has_place(world, key)) visit(key);
      }
    }
  }
}

}  // namespace runstone
