#include "client/map/map_tile.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kStone = 1;

MapMaterials some_materials() {
  MaterialTable table;
  REQUIRE(table.add({"stone", {100, 100, 100, 255}, Visibility::opaque, {}}).has_value());
  return map_materials(table);
}

/// A flat tile at this height.
MapTile tile_at(std::int32_t y) {
  MapTile tile{MapTops(kEdge), nullptr};
  tile.tops.surface.assign(tile.tops.surface.size(), ColumnTop{y, kStone});
  return tile;
}

int red_of(const OverlayImage& image, int x, int z) {
  return static_cast<int>(image.pixels[static_cast<std::size_t>(x + kEdge * z)] & 255U);
}

}  // namespace

TEST_CASE("slopes at borders come from the neighbours", "[client_map]") {
  const MapMaterials materials = some_materials();
  const MapTile lower = tile_at(1), upper = tile_at(3);
  const auto alone = paint_map_tile(upper.tops, nullptr, nullptr, materials);
  const auto beside = paint_map_tile(upper.tops, &lower, nullptr, materials);
  CHECK(alone->width == kEdge);
  CHECK(alone->height == kEdge);
  CHECK(red_of(*alone, 0, 4) == 100);
  CHECK(red_of(*beside, 0, 4) > 100);
  CHECK(red_of(*beside, 1, 4) == 100);
  CHECK(red_of(*paint_map_tile(lower.tops, nullptr, &upper, materials), 4, 0) < 100);
}

TEST_CASE("a tile with other heights at the east or the south has another border", "[client_map]") {
  const MapTile flat = tile_at(1);
  CHECK(has_other_border(nullptr, &flat));
  CHECK_FALSE(has_other_border(&flat, &flat));
  for (const auto& [x, z] :
       {std::pair{15, 3}, std::pair{3, 15}, std::pair{0, 3}, std::pair{3, 0}}) {
    MapTile other = flat;
    other.tops.surface[static_cast<std::size_t>(x + kEdge * z)].y = 9;
    CHECK(has_other_border(&flat, &other) == (x == 15 || z == 15));
  }
}
