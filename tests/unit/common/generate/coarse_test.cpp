// Coarse forms of generators are compared with the tiles that follow from their chunks.
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <set>

#include "common/core/hash.hpp"
#include "common/core/tile_keys.hpp"
#include "common/generate/columns_world.hpp"
#include "common/generate/generator.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/tile_rules.hpp"

using namespace runstone;

namespace {

constexpr int kEdge = 16;

std::unique_ptr<Generator> generator_of(const GeneratorPin& pin) {
  auto made = make_generator(pin, landscape_material_table());
  REQUIRE(made.has_value());
  return *std::move(made);
}

VisibilityTable visibility() {
  return VisibilityTable(half_filled_visibilities(landscape_material_table()));
}

/// Returns the tile that follows from all chunks below it.
RunChunk exact(const Generator& generator, const ChunkKey& key, const VisibilityTable& materials,
               TileScratch& scratch) {
  if (key.lod == 0) return generator.generate(origin_of(key.at, kEdge), Extent::cube(kEdge));
  std::array<RunChunk, 8> children;
  TileChildren pointers{};
  for (unsigned i = 0; i < 8; ++i) {
    children[i] = exact(generator, tile_child(key, i), materials, scratch);
    pointers[i] = &children[i];
  }
  return build_tile(pointers, kEdge, kTileOrder, materials, scratch);
}

/// Returns the height of a column of a tile: its highest voxel that is not empty + 1, or 0.
int height(const RunChunk& tile, int x, int z) {
  for (int y = kEdge; y > 0; --y) {
    if (material_at(tile, {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y - 1),
                           static_cast<std::uint8_t>(z)}) != kEmpty)
      return y;
  }
  return 0;
}

struct Comparison {
  int columns = 0, equal = 0, near = 0;  // near: heights that differ by one voxel of the tile
  int same_material = 0;                 // columns with the same material on top
  std::set<Material> exact_tops, coarse_tops;

  void add(const RunChunk& tile, const RunChunk& coarse) {
    for (int x = 0; x < kEdge; ++x) {
      for (int z = 0; z < kEdge; ++z) {
        const int expected = height(tile, x, z), found = height(coarse, x, z);
        ++columns;
        equal += expected == found ? 1 : 0;
        near += std::abs(expected - found) == 1 ? 1 : 0;
        if (expected == 0 || found == 0) {
          same_material += expected == found ? 1 : 0;
          continue;
        }
        const Material top = top_of(tile, x, expected, z);
        same_material += top == top_of(coarse, x, found, z) ? 1 : 0;
        exact_tops.insert(top);
        coarse_tops.insert(top_of(coarse, x, found, z));
      }
    }
  }
  static Material top_of(const RunChunk& tile, int x, int height, int z) {
    return material_at(tile, {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(height - 1),
                              static_cast<std::uint8_t>(z)});
  }
};

/// Returns how many tiles of a level are compared. A sanitizer makes each ten times as slow.
int tiles_of(std::uint8_t level) {
#ifdef RUNSTONE_SANITIZED
  return level == 3 ? 4 : 1;
#else
  return level == 3 ? 12 : 3;
#endif
}

Comparison compare(const Generator& generator, std::uint8_t level, int tiles, std::int32_t y) {
  const VisibilityTable materials = visibility();
  TileScratch scratch;
  Comparison out;
  SplitMix64 random(level);
  for (int i = 0; i < tiles; ++i) {
    const ChunkKey key{level, {random.between(-30, 30), y, random.between(-30, 30)}};
    const auto coarse = generator.coarse(tile_origin(key, kEdge), kEdge, level);
    REQUIRE(coarse.has_value());
    REQUIRE(validate(*coarse).has_value());
    out.add(exact(generator, key, materials, scratch), *coarse);
  }
  return out;
}

}  // namespace

TEST_CASE("coarse terrain has nearly the surface of the tiles from its chunks", "[generate]") {
  const auto terrain = generator_of({"terrain", 1, 7, ""});
  for (const std::uint8_t level : {std::uint8_t{3}, std::uint8_t{4}}) {
    const Comparison found = compare(*terrain, level, tiles_of(level), 0);
    CAPTURE(int{level}, found.columns, found.equal, found.near, found.same_material);
    CHECK(found.equal + found.near == found.columns);
    CHECK(found.equal >= found.columns * 95 / 100);
    CHECK(found.same_material >= found.columns * 65 / 100);
    CHECK(found.exact_tops == found.coarse_tops);
  }
}

TEST_CASE("a coarse landscape has nearly the surface of the tiles from its chunks", "[generate]") {
  const auto landscape = generator_of({"landscape", 1, 7, ""});
  for (const std::uint8_t level : {std::uint8_t{3}, std::uint8_t{4}}) {
    const Comparison found = compare(*landscape, level, tiles_of(level), 0);
    CAPTURE(int{level}, found.columns, found.equal, found.near, found.same_material);
    // Trees that stand alone are in the tiles of the chunks only, and forests have gaps there.
    CHECK(found.equal + found.near >= found.columns * 97 / 100);
    CHECK(found.equal >= found.columns * 60 / 100);
  }
}

TEST_CASE("a coarse flat world has the surface of the tiles from its chunks", "[generate]") {
  for (const char* parameters : {"", "height = 9\nground = \"slate\"", "height = 100"}) {
    const auto flat = generator_of({"flat", 1, 0, parameters});
    CAPTURE(parameters);
    const Comparison found = compare(*flat, 3, 1, *parameters == '\0' ? -1 : 0);
    CHECK(found.equal == found.columns);
    CHECK(found.same_material == found.columns);
  }
  const auto empty = generator_of({"empty", 1, 0, ""});
  CHECK(*empty->coarse({0, 0, 0}, kEdge, 3) == uniform_chunk(Extent::cube(kEdge), kEmpty));
}

TEST_CASE("coarse terrain is uniform above and below its surface", "[generate]") {
  const auto terrain = generator_of({"terrain", 1, 7, "y_min = -1024"});
  const RunChunk empty = uniform_chunk(Extent::cube(kEdge), kEmpty);
  CHECK(*terrain->coarse({128, 128, -128}, kEdge, 3) == empty);
  CHECK(*terrain->coarse({128, -1152, -128}, kEdge, 3) == empty);
  CHECK(*terrain->coarse({128, -512, -128}, kEdge, 3) ==
        uniform_chunk(Extent::cube(kEdge), *default_material_table().find("stone")));
}

TEST_CASE("a row of a coarse column has the material of its highest voxel that is not liquid",
          "[generate]") {
  Column column;
  column.reset(-5, 30);
  column.paint(-5, 7, 1);
  column.paint(7, 8, 2);
  column.paint(13, 14, 3);
  column.paint(14, 17, 4);
  const auto rows = [&](std::int32_t from, std::uint8_t level, Material liquid = kEmpty) {
    RunBuilder out(Extent{8, 8, 8}, AxisOrder::yxz);
    for (int i = 0; i < 64; ++i) column.emit_coarse(from, 8, level, liquid, out);
    const RunChunk chunk = out.finish();
    std::vector<Material> materials;
    for (std::uint8_t y = 0; y < 8; ++y) materials.push_back(material_at(chunk, {0, y, 0}));
    return materials;
  };
  CHECK(rows(-8, 2) == std::vector<Material>{1, 1, 1, 2, 0, 4, 4, 0});
  CHECK(rows(-16, 3) == std::vector<Material>{0, 1, 2, 4, 4, 0, 0, 0});
  CHECK(rows(8, 0) == std::vector<Material>{0, 0, 0, 0, 0, 3, 4, 4});
  CHECK(rows(32, 2) == std::vector<Material>(8, kEmpty));
  CHECK(rows(-8, 2, 4) == std::vector<Material>{1, 1, 1, 2, 0, 3, 4, 0});
  CHECK(rows(-8, 2, 1) == rows(-8, 2));
  CHECK(rows(-256, 8) == std::vector<Material>{1, 4, 0, 0, 0, 0, 0, 0});
}

TEST_CASE("a bounded world is coarse outside of its bounds only", "[generate]") {
  const auto scenario = generator_of({"scenario", 1, 0, "number = 1\nedge = 32"});
  CHECK(*scenario->coarse({128, 0, 0}, kEdge, 3) == uniform_chunk(Extent::cube(kEdge), kEmpty));
  CHECK_FALSE(scenario->coarse({0, 0, 0}, kEdge, 3).has_value());
  CHECK_FALSE(scenario->coarse({-4096, -4096, -4096}, kEdge, 8).has_value());
  const auto columns = ColumnsWorld::parse("x,y,runs_bottom_to_top\n0,0,3:41|-1:3\n");
  REQUIRE(columns.has_value());
  CHECK((*columns)->coarse({128, 0, 0}, kEdge, 3)->is_uniform());
  CHECK_FALSE((*columns)->coarse({0, 0, 0}, kEdge, 3).has_value());
}
