// Pinned worlds: equal pins give equal voxels on every compiler, build type and machine. A change
// of the output is a new generator version, never a new number in this file.
#include <catch2/catch.hpp>

#include "common/generate/generator.hpp"

using namespace runstone;

namespace {

/// Returns the generator. The ids of both tables agree.
auto generator_of(const GeneratorPin& pin) {
  return make_generator(pin, landscape_material_table());
}

Digest digest_at(const GeneratorPin& pin, VoxelPos origin, Extent extent) {
  const auto made = generator_of(pin);
  REQUIRE(made.has_value());
  return digest_of((*made)->generate(origin, extent));
}

/// Returns one world digest over y = -64 .. 96 of 8 x 8 chunks of edge 32.
Digest world_digest(const GeneratorPin& pin) {
  const auto made = generator_of(pin);
  REQUIRE(made.has_value());
  Digest sum;
  for (std::int32_t z = -4; z < 4; ++z) {
    for (std::int32_t y = -2; y < 3; ++y) {
      for (std::int32_t x = -4; x < 4; ++x) {
        const RunChunk chunk = (*made)->generate(origin_of({x, y, z}, 32), Extent::cube(32));
        sum = sum + world_digest_term({0, {x, y, z}}, digest_of(chunk));
      }
    }
  }
  return sum;
}

}  // namespace

TEST_CASE("terrain version 1 gives the pinned voxels", "[generate][golden]") {
  const GeneratorPin pin{"terrain", 1, 7, ""};
  CHECK(to_hex(digest_at(pin, {0, 32, 0}, Extent::cube(32))) == "060a799fda53cf7f1174e45b35beb740");
  CHECK(to_hex(digest_at(pin, {-96, 32, 160}, Extent::cube(32))) ==
        "0b8a04bc871c09021f1166ead6f16918");
  CHECK(to_hex(digest_at(pin, {-16, -64, -16}, Extent{8, 128, 8})) ==
        "1642a0af94b70f511d75cf90705e05a3");
  CHECK(to_hex(digest_at(pin, {536870000, 0, -536870912}, Extent::cube(64))) ==
        "126ca4c43320adcb09d1fcd668994d69");
  CHECK(to_hex(world_digest(pin)) == "00715fac4772631906ef7d2aa95b9848");
  CHECK(
      to_hex(world_digest({"terrain", 1, 0xffffffffffffffffULL, "sea_level = 20\npeak = \"\""})) ==
      "0a9025a38bd1613108ec0e16f830aa68");
}

TEST_CASE("coarse terrain of version 1 gives the pinned voxels", "[generate][golden]") {
  // Tiles are no part of the world: another approximation needs no other version of the generator.
  const auto terrain = *make_generator({"terrain", 1, 7, ""}, default_material_table());
  const auto digest = [&](VoxelPos origin, std::int32_t edge, std::uint8_t level) {
    return to_hex(digest_of(*terrain->coarse(origin, edge, level)));
  };
  CHECK(digest({0, 0, 0}, 32, 3) == "04481c2ae44883bd15bb2bb5498cf1dc");
  CHECK(digest({-1024, -1024, 2048}, 64, 4) == "191ffdd8eb8fb9381438e0ba046bd8dc");
  CHECK(digest({-536870912, -32768, 536838144}, 128, 8) == "09e656653db74b501813ae6e71d08093");
}

TEST_CASE("landscape version 1 gives the pinned voxels", "[generate][golden]") {
  const GeneratorPin pin{"landscape", 1, 7, ""};
  // Eight by eight chunks from the sea floor to the peaks, on two continents.
  const auto region = [](const GeneratorPin& of, std::int32_t x, std::int32_t z) {
    const auto made = generator_of(of);
    REQUIRE(made.has_value());
    Digest sum;
    for (std::int32_t k = z; k < z + 8; ++k) {
      for (std::int32_t y = -2; y < 20; ++y) {
        for (std::int32_t i = x; i < x + 8; ++i) {
          const RunChunk chunk = (*made)->generate(origin_of({i, y, k}, 32), Extent::cube(32));
          sum = sum + world_digest_term({0, {i, y, k}}, digest_of(chunk));
        }
      }
    }
    return to_hex(sum);
  };
  CHECK(region(pin, -4, -4) == "047f3efa2d5d49760b65d58525349797");
  CHECK(region(pin, 200, 150) == "10595c9188f19ab20193c2673167931d");
  CHECK(region(pin, 16777200, -16777216) == "110f6ce3e09e9b700459b67169134e58");
  CHECK(region({"landscape", 1, 0xffffffffffffffffULL,
                "sea_level = 20\ntrees = 150\nplants = 30\ncaves = 1"},
               -60, 40) == "19aaf9797975a8020348129ea16845ad");
  const auto spawn = (*generator_of(pin))->spawn();
  REQUIRE(spawn.has_value());
  CHECK(*spawn == VoxelPos{48, 65, -1200});
}

TEST_CASE("coarse landscape of version 1 gives the pinned voxels", "[generate][golden]") {
  const auto landscape = *generator_of({"landscape", 1, 7, ""});
  const auto digest = [&](VoxelPos origin, std::int32_t edge, std::uint8_t level) {
    return to_hex(digest_of(*landscape->coarse(origin, edge, level)));
  };
  CHECK(digest({0, 0, 0}, 32, 3) == "06a1430cc523473d0475c94d9730eab6");
  CHECK(digest({-1024, 0, 2048}, 64, 4) == "0e9eb86b1dde6c7d091cefd3b98b934f");
  CHECK(digest({-16384, -16384, -16384}, 64, 8) == "0a4193a9687e4ce305a471b0969a8eb0");
}

TEST_CASE("flat version 1 gives the pinned voxels", "[generate][golden]") {
  CHECK(to_hex(world_digest({"flat", 1, 0, ""})) == "055cd5d186d91e711aee77e053ce4794");
  CHECK(to_hex(digest_at({"flat", 1, 99, "height = 9\nground = \"slate\""}, {64, 0, 64},
                         Extent::cube(16))) == "0cc623eef66cfff30cc9235b6616344d");
}

TEST_CASE("empty version 1 gives the pinned voxels", "[generate][golden]") {
  CHECK(world_digest({"empty", 1, 5, ""}) == Digest{});
}

TEST_CASE("another seed gives another world", "[generate][golden]") {
  CHECK(world_digest({"terrain", 1, 7, ""}) != world_digest({"terrain", 1, 8, ""}));
}
