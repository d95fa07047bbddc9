#include "client/map/map_tile.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

constexpr std::int32_t kEdge = 16;
constexpr Material kStone = 1, kWater = 2, kGrass = 3;

MapMaterials some_materials() {
  MaterialTable table;
  REQUIRE(table.add({"stone", {100, 100, 100, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"water", {40, 80, 200, 128}, Visibility::transparent, {}}).has_value());
  REQUIRE(table.add({"grass", {60, 160, 60, 255}, Visibility::opaque, {}}).has_value());
  return map_materials(table);
}

RunChunk filled(Material material) { return uniform_chunk(Extent::cube(kEdge), material); }

void put(RunChunk& chunk, std::uint8_t x, std::uint8_t y, std::uint8_t z, Material material) {
  fill(chunk, index_of({x, y, z}, chunk.extent, chunk.order), 1, material);
}

MapTile tile_of(const std::vector<StackedChunk>& chunks) {
  std::size_t work = 0;
  return make_map_tile(chunks, kEdge, some_materials(), work);
}

std::array<int, 3> colour_of(const OverlayImage& image, int x, int z) {
  const std::uint32_t pixel = image.pixels[static_cast<std::size_t>(x + kEdge * z)];
  return {static_cast<int>(pixel & 255U), static_cast<int>(pixel >> 8 & 255U),
          static_cast<int>(pixel >> 16 & 255U)};
}

}  // namespace

TEST_CASE("a tile has the surface and the ground below it, across chunks", "[client_map]") {
  RunChunk upper = filled(kEmpty), lower = filled(kStone);
  put(upper, 3, 4, 5, kWater);
  put(upper, 6, 0, 7, kGrass);
  const MapTile tile = tile_of({{&upper, 16}, {&lower, 0}});
  CHECK(tile.at(0, 0) == ColumnTop{15, kStone});
  CHECK(tile.at(3, 5) == ColumnTop{20, kWater});
  CHECK(tile.ground[3 + kEdge * 5] == ColumnTop{15, kStone});
  CHECK(tile.at(6, 7) == ColumnTop{16, kGrass});
}

TEST_CASE("chunks below the ground are not visited", "[client_map]") {
  const RunChunk air = filled(kEmpty), stone = filled(kStone);
  std::size_t work = 0;
  static_cast<void>(make_map_tile(std::vector<StackedChunk>{{&air, 32}, {&stone, 16}}, kEdge,
                                  some_materials(), work));
  const std::size_t two = work;
  work = 0;
  static_cast<void>(make_map_tile(std::vector<StackedChunk>{{&air, 32}, {&stone, 16}, {&stone, 0}},
                                  kEdge, some_materials(), work));
  CHECK(work == two);
}

TEST_CASE("a flat tile has the colour of its material, and slopes are lighter or darker",
          "[client_map]") {
  RunChunk chunk = filled(kEmpty);
  for (std::uint8_t z = 0; z < kEdge; ++z) {
    for (std::uint8_t x = 0; x < kEdge; ++x) put(chunk, x, 2, z, kStone);
  }
  put(chunk, 8, 3, 8, kStone);
  const MapMaterials materials = some_materials();
  const MapTile tile = tile_of({{&chunk, 0}});
  const auto image = paint_map_tile(tile, nullptr, nullptr, materials);
  CHECK(colour_of(*image, 2, 2) == std::array{100, 100, 100});
  CHECK(colour_of(*image, 8, 8)[0] > 100);  // rises from west and north
  CHECK(colour_of(*image, 9, 8)[0] < 100);  // falls towards the east
  CHECK(colour_of(*image, 8, 9)[0] < 100);  // and towards the south
  CHECK(colour_of(*image, 0, 0) == std::array{100, 100, 100});
}

TEST_CASE("slopes at borders come from the neighbours", "[client_map]") {
  RunChunk low = filled(kEmpty), high = filled(kEmpty);
  for (std::uint8_t z = 0; z < kEdge; ++z) {
    for (std::uint8_t x = 0; x < kEdge; ++x) {
      put(low, x, 1, z, kStone);
      put(high, x, 3, z, kStone);
    }
  }
  const MapMaterials materials = some_materials();
  const MapTile lower = tile_of({{&low, 0}}), upper = tile_of({{&high, 0}});
  const auto alone = paint_map_tile(upper, nullptr, nullptr, materials);
  const auto beside = paint_map_tile(upper, &lower, nullptr, materials);
  CHECK(colour_of(*alone, 0, 4)[0] == 100);
  CHECK(colour_of(*beside, 0, 4)[0] > 100);
  CHECK(colour_of(*beside, 1, 4)[0] == 100);
  CHECK(colour_of(*paint_map_tile(lower, nullptr, &upper, materials), 4, 0)[0] < 100);
  CHECK(has_other_border(&lower, &upper));
  CHECK(has_other_border(nullptr, &upper));
  CHECK_FALSE(has_other_border(&upper, &upper));
}

TEST_CASE("deep water is bluer and darker than shallow water", "[client_map]") {
  RunChunk chunk = filled(kEmpty);
  const auto pool = [&](std::uint8_t x, std::uint8_t depth) {
    for (std::uint8_t z = 0; z < kEdge; ++z) {
      put(chunk, x, static_cast<std::uint8_t>(14 - depth), z, kStone);
      for (std::uint8_t y = static_cast<std::uint8_t>(15 - depth); y <= 14; ++y)
        put(chunk, x, y, z, kWater);
    }
  };
  pool(0, 1);
  pool(1, 12);
  const auto image = paint_map_tile(tile_of({{&chunk, 0}}), nullptr, nullptr, some_materials());
  const auto shallow = colour_of(*image, 0, 4), deep = colour_of(*image, 1, 4);
  CHECK(shallow[0] > deep[0]);  // the stone shows through
  CHECK(deep[2] > deep[0]);
  CHECK(deep[2] - deep[0] > shallow[2] - shallow[0]);
}

TEST_CASE("a column without a voxel is transparent, and an unknown material is no harm",
          "[client_map]") {
  RunChunk chunk = filled(kEmpty);
  put(chunk, 1, 1, 1, 60'000);
  const auto image = paint_map_tile(tile_of({{&chunk, 0}}), nullptr, nullptr, some_materials());
  CHECK(image->pixels[0] == 0);
  CHECK(image->pixels[1 + kEdge] >> 24 == 255);
}
