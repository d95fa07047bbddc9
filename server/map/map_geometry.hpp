// The geometry of the map: a square tile of kMapTileSide pixels. At zoom 0 a pixel is a column of
// voxels; at zoom n it is 2^n columns wide, and is drawn from the tiles of level n (docs/tiles.md).
#pragma once
#include <compare>
#include <cstdint>

#include "common/core/coords.hpp"
#include "common/core/tile_keys.hpp"

namespace runstone {

inline constexpr std::int32_t kMapTileSide = 512;  // pixels
inline constexpr std::uint8_t kMapZoomMax = kTileLevelMax;

/// The place of a tile of the map: its pixel (0, 0) is the column of voxels (x, z) * kMapTileSide *
/// 2^zoom.
struct MapPlace {
  std::uint8_t zoom = 0;
  std::int32_t x = 0, z = 0;
  friend auto operator<=>(const MapPlace&, const MapPlace&) = default;
};

/// Returns true if the whole tile lies in the world.
constexpr bool is_in_world(const MapPlace& place) {
  if (place.zoom > kMapZoomMax) return false;
  const std::int32_t tiles = kWorldLimit / (kMapTileSide << place.zoom);
  return place.x >= -tiles && place.x < tiles && place.z >= -tiles && place.z < tiles;
}
static_assert(kWorldLimit % (kMapTileSide << kMapZoomMax) == 0);

/// The place of a column of chunks, or of tiles of a level.
struct ColumnKey {
  std::uint8_t level = 0;
  std::int32_t x = 0, z = 0;
  friend auto operator<=>(const ColumnKey&, const ColumnKey&) = default;
};

constexpr ColumnKey column_of(const ChunkKey& key) { return {key.lod, key.at.x, key.at.z}; }

}  // namespace runstone
