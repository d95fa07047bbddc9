#include "client/map/map_tile.hpp"

#include <vector>

#include "common/map/map_painter.hpp"

namespace runstone {
namespace {

/// Returns the columns of the last x of a tile, by z.
std::vector<ColumnTop> east_columns(const MapTops& tops) {
  std::vector<ColumnTop> out;
  out.reserve(static_cast<std::size_t>(tops.edge));
  for (std::int32_t z = 0; z < tops.edge; ++z) out.push_back(tops.at(tops.edge - 1, z));
  return out;
}

/// Returns the columns of the last z of a tile, by x.
std::vector<ColumnTop> south_columns(const MapTops& tops) {
  return {tops.surface.end() - tops.edge, tops.surface.end()};
}

std::vector<std::int32_t> border_heights(const MapTile* tile) {
  std::vector<std::int32_t> out;
  if (tile == nullptr) return out;
  for (const ColumnTop& top : east_columns(tile->tops)) out.push_back(top.y);
  for (const ColumnTop& top : south_columns(tile->tops)) out.push_back(top.y);
  return out;
}

}  // namespace

std::size_t MapTile::bytes() const {
  return tops.bytes() + (image == nullptr ? 0 : image->pixels.size() * sizeof(std::uint32_t));
}

std::shared_ptr<const OverlayImage> paint_map_tile(const MapTops& tops, const MapTile* west,
                                                   const MapTile* north,
                                                   const MapMaterials& materials) {
  std::vector<ColumnTop> beside_west, beside_north;
  if (west != nullptr) beside_west = east_columns(west->tops);
  if (north != nullptr) beside_north = south_columns(north->tops);
  auto image = std::make_shared<OverlayImage>();
  image->width = image->height = tops.edge;
  image->pixels = paint_map(tops, beside_west, beside_north, materials);
  return image;
}

bool has_other_border(const MapTile* before, const MapTile* after) {
  return border_heights(before) != border_heights(after);
}

}  // namespace runstone
