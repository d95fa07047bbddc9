// What a contestant hands out is the mesh it made.
#include "tests/bench/contestant.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/bench/seeded_worlds.hpp"
#include "tests/support/triangle_oracle.hpp"

using namespace runstone;
using namespace runstone::bench;

TEST_CASE("every contestant hands out its last mesh, in place of what was there", "[bench]") {
  for (const VoxelWorld& world : seeded_worlds()) {
    for (const Volume& volume : volumes_of(world, 16)) {
      const auto owed = test::expected_faces(volume.scene, seeded_materials());
      reference::Surface surface;
      for (const std::string_view name : contestant_names()) {
        CAPTURE(world.name, name);
        const auto contestant = make_contestant(name, volume, *world.visibility);
        REQUIRE(contestant.has_value());
        PhaseTimes phases{};
        contestant->mesh(phases);
        surface.quads.emplace_back();  // left over from another
        surface.triangles.vertices.emplace_back();
        contestant->surface(surface);
        CHECK(surface.quads.size() == contestant->quads());
        CHECK(surface.triangles.vertices.empty() ==
              (owed.empty() || (name != "monotone" && name != "poly2tri")));
        if (name == "simple" || name == "rle_rdm" || name == "run_strips_hidden")
          continue;  // hidden faces too
        CHECK(test::surface_difference(surface, volume.scene.chunk.extent, seeded_materials(), owed)
                  .value_or("") == "");
      }
    }
  }
}
