// The seed of a new world.
#include <catch2/catch.hpp>
#include <set>

#include "server/store/world_folder.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

WorldMeta meta_of_new(const std::string& folder, const WorldCreation& creation) {
  auto opened = open_or_create_world(folder, creation);
  INFO((opened ? std::string() : opened.error()));
  REQUIRE(opened.has_value());
  return opened->store->meta();
}

}  // namespace

TEST_CASE("worlds without a seed each draw one, which they keep", "[store][sqlite]") {
  const TempFolder folder;
  WorldCreation terrain;
  terrain.generator = "terrain";
  std::set<std::uint64_t> seeds;
  for (int i = 0; i < 4; ++i) {
    const std::string world = folder / std::to_string(i);
    const WorldMeta meta = meta_of_new(world, terrain);
    seeds.insert(meta.generator.seed);
    CHECK(meta.generator.seed <= 0xffff'ffffU);
    CHECK(meta_of_new(world, terrain).generator.seed == meta.generator.seed);
    // Players arrive at the origin, also where another seed has the sea there.
    CHECK(meta.spawn.x == 0.5);
    CHECK(meta.spawn.z == 0.5);
  }
  CHECK(seeds.size() == 4);
}

TEST_CASE("a new world is a landscape with its plants, unless a generator is named",
          "[store][sqlite]") {
  const TempFolder folder;
  const WorldMeta landscape = meta_of_new(folder / "landscape", {});
  CHECK(landscape.generator.name == "landscape");
  CHECK(landscape.generator.seed <= 0xffff'ffffU);
  CHECK(landscape.materials == landscape_material_table());
  WorldCreation flat;
  flat.generator = "flat";
  CHECK(meta_of_new(folder / "flat", flat).materials == default_material_table());
}

TEST_CASE("a world with a seed has that one", "[store][sqlite]") {
  const TempFolder folder;
  WorldCreation creation;
  for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, ~std::uint64_t{0}}) {
    creation.seed = seed;
    CHECK(meta_of_new(folder / std::to_string(seed), creation).generator.seed == seed);
  }
}

TEST_CASE("a generator that has no dry ground gets a seed too", "[store][sqlite]") {
  const TempFolder folder;
  WorldCreation creation;
  creation.generator = "empty";
  CHECK(meta_of_new(folder / "empty", creation).generator.name == "empty");
  creation.generator = "terrain";
  creation.generator_parameters = "sea_level = 4000";
  CHECK(meta_of_new(folder / "sea", creation).generator.name == "terrain");
}
