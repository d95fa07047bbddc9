// The terrain is compared with its definition, voxel by voxel: one condition per rule, evaluated at
// single places.
#include "common/generate/terrain_generator.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

constexpr std::uint64_t kSeed = 7;

/// Returns the height of a rule's surface. Other tests cover the noise itself.
double height(const SurfaceRule& rule, std::int32_t x, std::int32_t z) {
  const ValueNoise noise(mix64(mix64(kSeed) + static_cast<std::uint64_t>(std::int64_t{rule.seed})),
                         rule.frequency);
  return rule.distance + rule.elevation * noise.at(x, z);
}

/// Returns the last material whose rule holds at a place, as the thesis' generator computes it for
/// every voxel.
Material ruled(const MaterialTable& table, std::int32_t y_min, VoxelPos at) {
  Material out = kEmpty;
  if (at.y < y_min) return out;
  for (std::size_t id = 0; id < table.size(); ++id) {
    const auto& rule = table[static_cast<Material>(id)].generation;
    if (!rule || !(at.y < height(rule->surface, at.x, at.z))) continue;
    if (rule->reversed && !(height(*rule->reversed, at.x, at.z) < at.y)) continue;
    out = static_cast<Material>(id);
  }
  return out;
}

struct Oracle {
  const MaterialTable& table;
  TerrainParameters p;

  /// Returns the height of a column before its cover.
  std::int32_t top_of(std::int32_t x, std::int32_t z) const {
    std::int32_t top = p.y_min;
    for (std::int32_t y = p.y_min; y < 200; ++y) {
      if (ruled(table, p.y_min, {x, y, z}) != kEmpty) top = y + 1;
    }
    return top;
  }
  Material at(VoxelPos at, std::int32_t top) const {
    const auto id = [&](const std::string& name) {
      return name.empty() ? kEmpty : *table.find(name);
    };
    Material out = ruled(table, p.y_min, at);
    const bool in_cover = at.y >= top - 3 && at.y < top && at.y >= p.y_min;
    if (id(p.beach) != kEmpty && top <= p.sea_level + p.beach_height) {
      if (in_cover) out = id(p.beach);
    } else {
      if (id(p.rock) != kEmpty && top > p.rock_level && in_cover) out = id(p.rock);
      if (id(p.peak) != kEmpty && top > p.peak_level && at.y == top - 1) out = id(p.peak);
    }
    if (out == kEmpty && at.y >= p.y_min && at.y < p.sea_level) out = id(p.water);
    return out;
  }
};

/// Compares a few columns over the whole height. Returns the number of voxels that differ.
int differences(const Generator& generator, const Oracle& oracle, SplitMix64& random, int columns) {
  int wrong = 0;
  for (int i = 0; i < columns; ++i) {
    const std::int32_t x = random.between(-600, 600), z = random.between(-600, 600);
    const std::int32_t ruled_top = oracle.top_of(x, z);
    std::int32_t top = generator.y_min();
    for (std::int32_t cy = -3; cy < 4; ++cy) {
      const ChunkCoord at = chunk_of({x, cy * 32, z}, 32);
      const RunChunk chunk = generator.generate(origin_of(at, 32), Extent::cube(32));
      for (std::int32_t y = cy * 32; y < cy * 32 + 32; ++y) {
        const Material found = material_at(chunk, local_of({x, y, z}, 32));
        wrong += static_cast<int>(found != oracle.at({x, y, z}, ruled_top));
        if (found != kEmpty) top = y + 1;
      }
    }
    wrong += static_cast<int>(generator.surface_y(x, z) != top);
  }
  return wrong;
}

}  // namespace

TEST_CASE("terrain follows its rules, voxel by voxel", "[generate]") {
  SplitMix64 random(Catch::rngSeed());
  const MaterialTable& table = default_material_table();
  TerrainParameters parameters;
  SECTION("with its defaults") {}
  SECTION("dry and bare") { parameters = {38, -64, "", "", 0, "", 0, "", 0}; }
  SECTION("with a high floor, a low sea and covers that overlap") {
    parameters = {30, 20, "water", "clay", 10, "slate", 35, "gold", 37};
  }
  const auto made = TerrainGenerator::make(kSeed, parameters, table);
  REQUIRE(made.has_value());
  CHECK(differences(**made, {table, parameters}, random, 12) == 0);
}

TEST_CASE("terrain follows rules with steep and with reversed surfaces", "[generate]") {
  // Overhangs: a slab between two surfaces, with air and another material below.
  MaterialTable table;
  REQUIRE(table.add({"low",
                     {1, 1, 1, 255},
                     Visibility::opaque,
                     GenerationRule{{1, 30, -20, 0.05}, std::nullopt}}));
  REQUIRE(table.add({"slab",
                     {2, 2, 2, 255},
                     Visibility::opaque,
                     GenerationRule{{2, 20, 40, 0.03}, SurfaceRule{3, -60, 20, 0.2}}}));
  const TerrainParameters parameters{0, -50, "", "", 0, "", 0, "", 0};
  SplitMix64 random(Catch::rngSeed());
  const auto made = TerrainGenerator::make(kSeed, parameters, table);
  REQUIRE(made.has_value());
  CHECK(differences(**made, {table, parameters}, random, 12) == 0);

  // The same with the rules in reverse order, where the solid ground is painted last.
  MaterialTable turned;
  REQUIRE(turned.add(table[2]));
  REQUIRE(turned.add(table[1]));
  const auto other = TerrainGenerator::make(kSeed, parameters, turned);
  REQUIRE(other.has_value());
  CHECK(differences(**other, {turned, parameters}, random, 12) == 0);
}

TEST_CASE("the voxel oracle detects terrain with another parameter", "[generate]") {
  SplitMix64 random(1);
  const MaterialTable& table = default_material_table();
  const auto made = TerrainGenerator::make(kSeed, TerrainParameters{}, table);
  REQUIRE(made.has_value());
  TerrainParameters other;
  other.beach_height = 4;
  other.sea_level = 40;
  CHECK(differences(**made, {table, other}, random, 12) > 0);
}

TEST_CASE("chunks out of the terrain's bounds and deep below it are single runs", "[generate]") {
  const MaterialTable& table = default_material_table();
  const auto made = make_generator({"terrain", 1, kSeed, "y_min = -200"}, table);
  REQUIRE(made.has_value());
  const Generator& terrain = **made;
  CHECK(terrain.generate({0, terrain.y_max(), 0}, Extent::cube(32)) ==
        uniform_chunk(Extent::cube(32), kEmpty));
  CHECK(terrain.generate({0, -232, 0}, Extent::cube(32)) ==
        uniform_chunk(Extent::cube(32), kEmpty));
  const RunChunk deep = terrain.generate({0, -128, 0}, Extent::cube(32));
  CHECK(deep == uniform_chunk(Extent::cube(32), *table.find("stone")));
}
