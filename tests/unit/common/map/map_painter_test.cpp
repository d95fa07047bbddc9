#include "common/map/map_painter.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

#include "common/core/coords.hpp"
#include "common/core/hash.hpp"

using namespace runstone;

namespace {

constexpr Material kStone = 1, kWater = 2;

MapMaterials some_materials() {
  MaterialTable table;
  REQUIRE(table.add({"stone", {100, 100, 100, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"water", {40, 80, 200, 128}, Visibility::transparent, {}}).has_value());
  return map_materials(table);
}

MapTops flat(std::int32_t edge, std::int32_t y) {
  MapTops out(edge);
  out.surface.assign(out.surface.size(), ColumnTop{y, kStone});
  out.ground = out.surface;
  return out;
}

std::array<int, 3> rgb_of(std::uint32_t pixel) {
  return {static_cast<int>(pixel & 255U), static_cast<int>(pixel >> 8 & 255U),
          static_cast<int>(pixel >> 16 & 255U)};
}

/// The oracle: the colour of one pixel, by the words of the header.
std::uint32_t plain_pixel(const MapTops& tops, std::span<const ColumnTop> west,
                          std::span<const ColumnTop> north, const MapMaterials& materials,
                          std::int32_t x, std::int32_t z, std::int32_t unit) {
  const ColumnTop here = tops.at(x, z);
  if (!here.is_found()) return 0;
  const ColumnTop ground = tops.ground_or_surface()[static_cast<std::size_t>(x + tops.edge * z)];
  double slope = 0;
  const auto add = [&](const ColumnTop& beside) {
    if (beside.is_found()) slope += std::clamp(double(here.y) - beside.y, -3.0, 3.0);
  };
  if (x > 0) add(tops.at(x - 1, z));
  if (x == 0 && !west.empty()) add(west[static_cast<std::size_t>(z)]);
  if (z > 0) add(tops.at(x, z - 1));
  if (z == 0 && !north.empty()) add(north[static_cast<std::size_t>(x)]);
  const MaterialColour top = materials.colour(here.material);
  const MaterialColour below = ground.is_found() ? materials.colour(ground.material) : top;
  const double depth = ground.is_found() ? std::min(48.0, double(here.y - ground.y) * unit) : 48;
  const double kept = std::pow(1 - 0.35 * top[3] / 255.0, depth);
  std::uint32_t out = 0xFF000000U;
  for (std::size_t i = 0; i < 3; ++i) {
    const double dark = 1 - 0.35 * depth / 48;
    const double colour = depth == 0 ? top[i] : top[i] * dark * (1 - kept) + below[i] * kept;
    const double lit = std::clamp(colour * (1 + 0.11 * slope), 0.0, 255.0);
    out |= static_cast<std::uint32_t>(std::lround(lit)) << (8 * i);
  }
  return out;
}

}  // namespace

TEST_CASE("the pixels of random tops are those of the plain formula", "[map]") {
  SplitMix64 rng{Catch::rngSeed()};
  const MapMaterials materials = some_materials();
  for (int round = 0; round < 20; ++round) {
    const std::int32_t edge = rng.between(1, 40), unit = 1 << rng.below(9);
    const auto column = [&] {
      return ColumnTop{rng.between(-6, 6), static_cast<Material>(1 + rng.below(3))};
    };
    MapTops tops(edge);
    tops.ground.resize(tops.surface.size());
    for (std::size_t i = 0; i < tops.surface.size(); ++i) {
      if (rng.below(10) == 0) continue;
      tops.surface[i] = column();
      tops.ground[i] = tops.surface[i];
      if (tops.surface[i].material != kWater) continue;
      tops.ground[i] = {tops.surface[i].y - rng.between(1, 60), kStone};
      if (rng.below(8) == 0) tops.ground[i] = {};
    }
    std::vector<ColumnTop> west, north;
    for (std::int32_t i = 0; i < edge && round % 2 == 0; ++i) {
      west.push_back(rng.below(4) == 0 ? ColumnTop{} : column());
      north.push_back(column());
    }
    const auto pixels = paint_map(tops, west, north, materials, unit);
    REQUIRE(pixels.size() == tops.surface.size());
    for (std::int32_t z = 0; z < edge; ++z) {
      for (std::int32_t x = 0; x < edge; ++x) {
        CAPTURE(Catch::rngSeed(), round, x, z, unit);
        REQUIRE(pixels[static_cast<std::size_t>(x + edge * z)] ==
                plain_pixel(tops, west, north, materials, x, z, unit));
      }
    }
  }
}

TEST_CASE("a flat map has the colour of its material, and slopes are lighter or darker", "[map]") {
  MapTops tops = flat(16, 2);
  tops.surface[8 + 16 * 8].y = tops.ground[8 + 16 * 8].y = 3;
  const auto pixels = paint_map(tops, {}, {}, some_materials());
  CHECK(rgb_of(pixels[2 + 16 * 2]) == std::array{100, 100, 100});
  CHECK(rgb_of(pixels[8 + 16 * 8])[0] > 100);  // rises from west and north
  CHECK(rgb_of(pixels[9 + 16 * 8])[0] < 100);  // falls towards the east
  CHECK(rgb_of(pixels[8 + 16 * 9])[0] < 100);  // and towards the south
}

TEST_CASE("deep water is bluer and darker than shallow water", "[map]") {
  MapTops tops = flat(2, 0);
  tops.surface[0] = {1, kWater};
  tops.surface[1] = {12, kWater};
  const auto pixels = paint_map(tops, {}, {}, some_materials());
  const auto shallow = rgb_of(pixels[0]), deep = rgb_of(pixels[1]);
  CHECK(deep[2] - deep[0] > shallow[2] - shallow[0]);
  // A unit of eight voxels makes the shallow water eight times as deep.
  CHECK(paint_map(tops, {}, {}, some_materials(), 8)[0] != pixels[0]);
}

TEST_CASE("a column without a voxel is transparent, and an unknown material is no harm", "[map]") {
  MapTops tops(2);
  tops.ground.resize(tops.surface.size());
  tops.surface[1] = tops.ground[1] = {1, 60'000};
  const auto pixels = paint_map(tops, {}, {}, some_materials());
  CHECK(pixels[0] == 0);
  CHECK(pixels[1] == 0xFFFF00FFU);
  // Heights at the ends of the world do not overflow.
  tops.surface[0] = tops.ground[0] = {kWorldLimit - 1, kStone};
  tops.surface[1] = tops.ground[1] = {-kWorldLimit, kStone};
  CHECK(paint_map(tops, {}, {}, some_materials(), 256)[0] >> 24 == 255);
}

TEST_CASE("a map shows no shape that fills less than half of its voxel", "[map][shapes]") {
  MaterialTable table;
  const Shape plant{ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  MaterialInfo info{"plant", {10, 200, 10, 255}, Visibility::opaque, {}};
  info.shape = plant;
  REQUIRE(table.add(info));
  info.name = "slab";
  info.shape = slab;
  REQUIRE(table.add(info));
  const MapMaterials materials = map_materials(table);
  CHECK(materials.showing == ShowingMaterials{false, false, true});
  CHECK(materials.ground == ShowingMaterials{false, false, true});
}
