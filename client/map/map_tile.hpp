// MapTile: one column of chunks from above: its tops, and an image of all of them as common/map
// paints it. Pure.
#pragma once
#include <compare>
#include <cstdint>
#include <memory>

#include "client/render/overlay_frame.hpp"
#include "common/map/map_materials.hpp"
#include "common/map/map_tops.hpp"

namespace runstone {

/// The place of a tile: x and z of its chunks.
struct MapTileKey {
  std::int32_t x = 0, z = 0;
  friend auto operator<=>(const MapTileKey&, const MapTileKey&) = default;
};

struct MapTile {
  MapTops tops;
  std::shared_ptr<const OverlayImage> image;  // null until it is painted; +x right, +z down

  std::size_t bytes() const;
};

/// Returns the painted image of a tile. The neighbours to the west (-x) and to the north (-z) give
/// the slopes at the borders; null: not known. Cost: O(columns).
std::shared_ptr<const OverlayImage> paint_map_tile(const MapTops& tops, const MapTile* west,
                                                   const MapTile* north,
                                                   const MapMaterials& materials);

/// Returns true if the tiles have other heights at the borders on which the slopes of the
/// neighbours to the east and to the south depend. Null stands for no tile.
bool has_other_border(const MapTile* before, const MapTile* after);

}  // namespace runstone
