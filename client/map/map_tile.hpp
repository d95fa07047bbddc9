// MapTile: one column of chunks from above: for each column of voxels the voxel that shows, and an
// image of all of them. The image has shaded relief: slopes towards the west and the north are
// light, as if the sun stood there. Water and glass are tinted by the depth to the ground below
// them. Pure.
#pragma once
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "client/map/map_materials.hpp"
#include "client/render/overlay_frame.hpp"
#include "common/runs/column_tops.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The place of a tile: x and z of its chunks.
struct MapTileKey {
  std::int32_t x = 0, z = 0;
  friend auto operator<=>(const MapTileKey&, const MapTileKey&) = default;
};

/// A chunk of a column, for MapTile.
struct StackedChunk {
  const RunChunk* voxels = nullptr;  // not null
  std::int32_t base_y = 0;           // of its lowest voxels
};

struct MapTile {
  std::int32_t edge = 0;
  std::vector<ColumnTop> surface;             // what shows; column (x, z) is x + edge * z
  std::vector<ColumnTop> ground;              // the highest opaque voxel, at or below the surface
  std::shared_ptr<const OverlayImage> image;  // null until it is painted; +x right, +z down

  const ColumnTop& at(std::int32_t x, std::int32_t z) const {
    return surface[static_cast<std::size_t>(x + edge * z)];
  }
  std::size_t bytes() const;
};

/// Returns the tile of these chunks, without an image. Requires chunks from the highest to the
/// lowest, cubes of one edge. Adds the runs and columns that were visited to `work`. Cost: as
/// find_column_tops() for each chunk down to the ground.
MapTile make_map_tile(std::span<const StackedChunk> chunks, std::int32_t edge,
                      const MapMaterials& materials, std::size_t& work);

/// Returns the painted image of a tile. The neighbours to the west (-x) and to the north (-z) give
/// the slopes at the borders; null: not known. Cost: O(columns).
std::shared_ptr<const OverlayImage> paint_map_tile(const MapTile& tile, const MapTile* west,
                                                   const MapTile* north,
                                                   const MapMaterials& materials);

/// Returns true if the tiles have other heights at the borders on which the slopes of the
/// neighbours to the east and to the south depend. Null stands for no tile.
bool has_other_border(const MapTile* before, const MapTile* after);

}  // namespace runstone
