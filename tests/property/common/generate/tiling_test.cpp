// A voxel of a generated world does not depend on the chunk that contains it.
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/generate/generator.hpp"

using namespace runstone;

namespace {

Material voxel(const Generator& generator, VoxelPos at, Extent extent, VoxelPos origin) {
  const RunChunk chunk = generator.generate(origin, extent);
  REQUIRE(validate(chunk).has_value());
  REQUIRE(chunk.extent == extent);
  return material_at(chunk, {static_cast<std::uint8_t>(at.x - origin.x),
                             static_cast<std::uint8_t>(at.y - origin.y),
                             static_cast<std::uint8_t>(at.z - origin.z)});
}

std::uint8_t random_side(SplitMix64& random) {
  return static_cast<std::uint8_t>(random.between(8, 48));
}

}  // namespace

TEST_CASE("a voxel is the same in every chunk that holds it", "[generate][property]") {
  const auto name = GENERATE(as<std::string>{}, "empty", "flat", "landscape", "terrain");
  SplitMix64 random(Catch::rngSeed());
  for (int round = 0; round < 60; ++round) {
    const auto made =
        make_generator({name, 1, random.below(5), name == "landscape" ? "caves = 1" : ""},
                       landscape_material_table());
    REQUIRE(made.has_value());
    const Generator& generator = **made;
    const std::int32_t reach = round % 8 == 0 ? kWorldLimit - 200 : 500;
    VoxelPos at{random.between(-reach, reach),
                random.between(generator.y_min() - 20, generator.y_max() + 20),
                random.between(-reach, reach)};
    if (round % 2 == 1) at.y = generator.surface_y(at.x, at.z) + random.between(-12, 4);
    const Material expected =
        voxel(generator, at, Extent::cube(32), origin_of(chunk_of(at, 32), 32));
    CAPTURE(name, at.x, at.y, at.z);
    REQUIRE(voxel(generator, at, Extent::cube(16), origin_of(chunk_of(at, 16), 16)) == expected);
    REQUIRE(voxel(generator, at, Extent::cube(64), origin_of(chunk_of(at, 64), 64)) == expected);
    REQUIRE(voxel(generator, at, Extent::cube(128), origin_of(chunk_of(at, 128), 128)) == expected);
    const Extent odd{random_side(random), random_side(random), random_side(random)};
    const VoxelPos origin{at.x - random.between(0, odd.x - 1), at.y - random.between(0, odd.y - 1),
                          at.z - random.between(0, odd.z - 1)};
    REQUIRE(voxel(generator, at, odd, origin) == expected);
  }
}

TEST_CASE("the surface is the top of the voxels, and the bounds hold them all",
          "[generate][property]") {
  const auto name = GENERATE(as<std::string>{}, "flat", "landscape", "terrain");
  SplitMix64 random(Catch::rngSeed());
  const auto made = make_generator({name, 1, 11, ""}, landscape_material_table());
  REQUIRE(made.has_value());
  const Generator& generator = **made;
  for (int round = 0; round < 200; ++round) {
    const std::int32_t x = random.between(-5000, 5000), z = random.between(-5000, 5000);
    const std::int32_t y = generator.surface_y(x, z);
    CAPTURE(name, x, y, z);
    REQUIRE(y <= generator.y_max());
    REQUIRE(y > generator.y_min());
    const RunChunk around = generator.generate({x, y - 8, z}, Extent{8, 128, 8});
    REQUIRE(material_at(around, {0, 7, 0}) != kEmpty);
    for (std::uint8_t up = 8; up < 128; ++up) REQUIRE(material_at(around, {0, up, 0}) == kEmpty);
  }
}
