#include "client/map/map_tile.hpp"

#include <span>
#include <vector>

#include "common/map/map_painter.hpp"

namespace runstone {
namespace {

std::vector<std::int32_t> border_heights(const MapTile* tile) {
  std::vector<std::int32_t> out;
  if (tile == nullptr) return out;
  for (const ColumnTop& top : tile->tops.last_x()) out.push_back(top.y);
  for (const ColumnTop& top : tile->tops.last_z()) out.push_back(top.y);
  return out;
}

}  // namespace

std::size_t MapTile::bytes() const {
  return tops.bytes() + (image == nullptr ? 0 : image->pixels.size() * sizeof(std::uint32_t));
}

std::shared_ptr<const OverlayImage> paint_map_tile(const MapTops& tops, const MapTile* west,
                                                   const MapTile* north,
                                                   const MapMaterials& materials) {
  std::vector<ColumnTop> beside_west;
  std::span<const ColumnTop> beside_north;
  if (west != nullptr) beside_west = west->tops.last_x();
  if (north != nullptr) beside_north = north->tops.last_z();
  auto image = std::make_shared<OverlayImage>();
  image->width = image->height = tops.edge;
  image->pixels = paint_map(tops, beside_west, beside_north, materials);
  return image;
}

bool has_other_border(const MapTile* before, const MapTile* after) {
  return border_heights(before) != border_heights(after);
}

}  // namespace runstone
