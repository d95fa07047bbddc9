#include "common/generate/landscape/landscape_generator.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <thread>

#include "common/core/hash.hpp"
#include "common/core/tile_keys.hpp"
#include "common/generate/spawn_point.hpp"
#include "tests/unit/common/generate/landscape/landscape_world.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

constexpr std::int32_t kLandEdge = LandscapeVoxels::kEdge;
/// The landscapes that the dear tests look at. A sanitizer makes each ten times as slow.
#ifdef RUNSTONE_SANITIZED
constexpr std::uint64_t kSeeds = 1;
#else
constexpr std::uint64_t kSeeds = 2;
#endif

ErrorCode landscape_error(std::uint64_t seed, const std::string& parameters) {
  const auto made = make_generator({"landscape", 1, seed, parameters}, landscape_material_table());
  return made ? ErrorCode{} : made.error().code;
}

/// Returns a place on a river that lies above the sea, near a node of the drainage.
std::optional<VoxelPos> river_near(std::uint64_t seed, std::int32_t square_x) {
  const LandForm form(seed);
  for (std::int32_t z = -2000; z < 2000; z += 8) {
    for (std::int32_t x = square_x * kDrainageWidth; x < (square_x + 1) * kDrainageWidth; x += 8) {
      const LandSample at = form.at(x, z);
      if (at.shore < 0 && at.water > 3) return VoxelPos{x, at.water, z};
    }
  }
  return std::nullopt;
}

void check_arrival(std::uint64_t seed) {
  CAPTURE(seed);
  const MaterialTable& materials = landscape_material_table();
  const auto land = landscape_of(seed);
  const auto spawn = land->spawn();
  REQUIRE(spawn.has_value());
  const VoxelPos at = spawn_point(*land, materials);
  CHECK(at == *spawn);
  CHECK(std::max(std::abs(at.x), std::abs(at.z)) <= 1536);
  LandscapeVoxels voxels(*land);
  CHECK(materials[voxels.at({at.x, at.y - 3, at.z})].visibility == Visibility::opaque);
  CHECK(voxels.at({at.x, at.y, at.z}) == kEmpty);
  for (std::int32_t x = at.x - 4; x <= at.x + 4; ++x) {
    for (std::int32_t z = at.z - 4; z <= at.z + 4; ++z) {
      CHECK(voxels.at({x, at.y - 5, z}) != kEmpty);
      CHECK(voxels.at({x, at.y - 5, z}) != named("water"));
      for (std::int32_t y = at.y + 1; y < at.y + 16; ++y) CHECK(voxels.at({x, y, z}) == kEmpty);
    }
  }
}

void check_variety(std::uint64_t seed) {
  CAPTURE(seed);
  const auto land = landscape_of(seed);
  std::size_t sea = 0, snow = 0, forest = 0;
  for (std::int32_t x = -4; x < 4; ++x) {
    for (std::int32_t z = -4; z < 4; ++z) {
      for (std::int32_t y = -1; y < 1; ++y) {
        const auto tile = land->coarse(tile_origin({7, {x, y, z}}, kLandEdge), kLandEdge, 7);
        REQUIRE(tile.has_value());
        sea += count_of(*tile, named("water"));
        snow += count_of(*tile, named("snow"));
        forest += count_of(*tile, named("leaves")) + count_of(*tile, named("pine_leaves"));
      }
    }
  }
  CHECK(sea > 500);
  CHECK(snow > 50);
  CHECK(forest > 2000);
}

}  // namespace

TEST_CASE("no side of water stands beside an empty voxel", "[generate][landscape]") {
  const Material water = named("water");
  int found = 0, above_sea = 0;
  for (std::uint64_t seed = 1; seed <= 2 * kSeeds; ++seed) {
    const auto river = river_near(seed, static_cast<std::int32_t>(seed) - 2);
    REQUIRE(river.has_value());
    for (const char* parameters : {"", "caves = 1"}) {
      const auto land = landscape_of(seed, parameters);
      LandscapeVoxels voxels(*land);
      CAPTURE(seed, river->x, river->y, river->z, parameters);
      for (std::int32_t x = river->x - 40; x < river->x + 40; ++x) {
        for (std::int32_t z = river->z - 40; z < river->z + 40; ++z) {
          for (std::int32_t y = river->y - 6; y < river->y + 10; ++y) {
            if (voxels.at({x, y, z}) != water) continue;
            ++found;
            above_sea += y >= 0 ? 1 : 0;
            for (const auto& [dx, dz] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
              if (voxels.at({x + dx, y, z + dz}) == kEmpty)
                FAIL("open water at " << x << " " << y << " " << z);
            }
            if (voxels.at({x, y - 1, z}) == kEmpty)
              FAIL("water above nothing at " << x << " " << y << " " << z);
          }
        }
      }
    }
  }
  CHECK(found > 500 * static_cast<int>(kSeeds));
  CHECK(above_sea > 250 * static_cast<int>(kSeeds));
}

TEST_CASE("plants grow below the crowns of trees, and no trunk is a plant",
          "[generate][landscape]") {
  const auto land = landscape_of(7, "trees = 200\nplants = 400");
  LandscapeVoxels voxels(*land);
  const Material leaves = named("leaves");
  const auto spawn = land->spawn();
  REQUIRE(spawn.has_value());
  int below_crowns = 0;
  for (std::int32_t x = spawn->x - 64; x < spawn->x + 64; ++x) {
    for (std::int32_t z = spawn->z - 64; z < spawn->z + 64; ++z) {
      const std::int32_t top = land->surface_y(x, z);
      if (voxels.at({x, top - 1, z}) != leaves) continue;
      for (std::int32_t y = top - 2; y > top - 16; --y) {
        if (voxels.at({x, y, z}) == named("tall_grass") || voxels.at({x, y, z}) == named("fern")) {
          ++below_crowns;
          CHECK(voxels.at({x, y - 1, z}) != kEmpty);
        }
      }
    }
  }
  CHECK(below_crowns > 20);
}

TEST_CASE("tunnels of a column ascend and do not touch", "[generate][landscape]") {
  const LandForm form(3);
  const auto materials = LandMaterials::find(landscape_material_table());
  REQUIRE(materials.has_value());
  int pairs = 0;
  for (std::int32_t x = -1024; x < 1024; x += 64) {
    const LandColumns land(form, *materials, {0, 0, true}, 3, x, 0, 64, 64);
    const auto& hollows = land.hollows();
    for (std::size_t i = 1; i < hollows.size(); ++i) {
      if (hollows[i - 1].column != hollows[i].column) continue;
      ++pairs;
      CHECK(hollows[i - 1].tunnel.to < hollows[i].tunnel.from);
    }
  }
  CHECK(pairs > 10);
}

TEST_CASE("chunks come out alike in any order and from any thread", "[generate][landscape]") {
  std::vector<ChunkCoord> keys;
  for (std::int32_t x = -2; x < 2; ++x) {
    for (std::int32_t z = -2; z < 2; ++z) {
      for (std::int32_t y = -1; y < 5; ++y) keys.push_back({x, y, z});
    }
  }
  const auto all = [&](const Generator& land) {
    std::vector<Digest> out(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
      out[i] = digest_of(land.generate(origin_of(keys[i], kLandEdge), Extent::cube(kLandEdge)));
    return out;
  };
  const std::vector<Digest> expected = all(*landscape_of(7));
  const auto backwards = landscape_of(7);
  for (std::size_t i = keys.size(); i-- > 0;) {
    REQUIRE(digest_of(backwards->generate(origin_of(keys[i], kLandEdge),
                                          Extent::cube(kLandEdge))) == expected[i]);
  }
  const auto shared = landscape_of(7);
  std::array<std::vector<Digest>, 3> found;
  std::vector<std::thread> threads;
  for (std::vector<Digest>& out : found) threads.emplace_back([&] { out = all(*shared); });
  for (std::thread& thread : threads) thread.join();
  for (const std::vector<Digest>& out : found) CHECK(out == expected);
}

TEST_CASE("high and deep chunks of a landscape are uniform", "[generate][landscape]") {
  const auto land = landscape_of(7);
  const RunChunk air = uniform_chunk(Extent::cube(kLandEdge), kEmpty);
  const RunChunk stone = uniform_chunk(Extent::cube(kLandEdge), named("stone"));
  SplitMix64 random(1);
  for (int i = 0; i < 20; ++i) {
    const std::int32_t x = random.between(-500, 500) * kLandEdge,
                       z = random.between(-500, 500) * kLandEdge;
    CHECK(land->generate({x, 992, z}, Extent::cube(kLandEdge)) == air);
    CHECK(land->generate({x, -128, z}, Extent::cube(kLandEdge)) == stone);
    CHECK(land->generate({x, -288, z}, Extent::cube(kLandEdge)) == air);
  }
}

TEST_CASE("parameters of a landscape have limits", "[generate][landscape]") {
  for (const char* good :
       {"", "sea_level = 99000\ny_min = 98000", "sea_level = -99000\ny_min = -99096",
        "trees = 0\nplants = 0", "trees = 200\nplants = 400\ncaves = 1"}) {
    CAPTURE(good);
    CHECK(landscape_error(7, good) == ErrorCode{});
  }
  for (const char* bad : {"y_min = -95", "sea_level = -200\ny_min = -256", "trees = -1",
                          "trees = 201", "plants = 401", "caves = 2", "caves = true", "rivers = 1",
                          "sea_level = 100001", "y_min = -100001"}) {
    CAPTURE(bad);
    CHECK(landscape_error(7, bad) == ErrorCode::bad_value);
  }
  CHECK(make_generator({"landscape", 2, 7, ""}, landscape_material_table()).error().code ==
        ErrorCode::bad_version);
  CHECK(make_generator({"landscape", 1, 7, ""}, default_material_table()).error().code ==
        ErrorCode::not_found);
  const auto bare = landscape_of(7, "trees = 0\nplants = 0");
  for (std::int32_t x = -4; x < 4; ++x) {
    for (std::int32_t y = 0; y < 4; ++y) {
      const RunChunk chunk =
          bare->generate({x * kLandEdge, y * kLandEdge, 0}, Extent::cube(kLandEdge));
      for (const Material material : {named("leaves"), named("log"), named("tall_grass")})
        CHECK(count_of(chunk, material) == 0);
    }
  }
}

TEST_CASE("a landscape works with each seed and at the ends of the world",
          "[generate][landscape]") {
  for (const std::uint64_t seed :
       {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}, std::uint64_t{1} << 63}) {
    const auto land = landscape_of(seed);
    for (const std::int32_t x : {-kWorldLimit, 0, kWorldLimit - kLandEdge}) {
      for (const std::int32_t z : {-kWorldLimit, kWorldLimit - kLandEdge}) {
        const std::int32_t top = land->surface_y(x, z);
        CHECK(top > -100);
        CHECK(top < 1000);
        const VoxelPos origin{x, top - 16, z};
        CHECK(validate(land->generate(origin, Extent::cube(kLandEdge))).has_value());
        const ChunkKey tile{8, chunk_of({x, 0, z}, kLandEdge << 8)};
        CHECK(validate(*land->coarse(tile_origin(tile, kLandEdge), kLandEdge, 8)).has_value());
      }
    }
  }
}

TEST_CASE("players arrive on level and dry ground without trees", "[generate][landscape][spawn]") {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) check_arrival(seed);
}

TEST_CASE("a landscape has sea, snow and forests within 16 km of its origin",
          "[generate][landscape]") {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) check_variety(seed);
}

TEST_CASE("landscapes of more seeds have variety and places to arrive at", "[.long]") {
  for (std::uint64_t seed = 3; seed <= 12; ++seed) check_arrival(seed);
  for (std::uint64_t seed = 3; seed <= 6; ++seed) check_variety(seed);
}
