// The meshers of polygons, monotone and Poly2Tri, compared with the triangle oracle: the exposed
// faces with material and direction, each covered once, and no vertices but corners of the faces'
// outlines.
#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/mesh/polygon_checks.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::test {
namespace {

std::string fault_of(PolygonChecks& checks, const MeshScene& scene) {
  return checks.fault(scene, mesh_visibility(), mesh_materials(), expected_faces(scene));
}

TEST_CASE("random scenes: meshers of polygons cover exactly the exposed faces",
          "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 51);
  PolygonChecks checks;
  std::size_t touching = 0;
  for (int scene_number = 0; scene_number < 3000; ++scene_number) {
    const unsigned side_max = scene_number % 200 == 0 ? 40 : scene_number % 20 == 0 ? 20 : 10;
    const MeshScene scene = random_scene(rng, side_max);
    const std::string fault = fault_of(checks, scene);
    touching += checks.touching_corners();
    if (fault.empty()) continue;
    CAPTURE(Catch::rngSeed(), scene_number);
    FAIL(fault);
  }
  CHECK(touching > 500);
}

TEST_CASE("the largest and the flattest extents: meshers of polygons",
          "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 52);
  PolygonChecks checks;
  for (const Extent extent : {Extent{128, 8, 8}, Extent{8, 128, 9}, Extent{10, 8, 128},
                              Extent{128, 128, 8}, Extent{65, 64, 63}}) {
    const MeshScene scene = scene_of_extent(rng, extent, random_order(rng));
    CAPTURE(Catch::rngSeed(), extent.x, extent.y, extent.z);
    REQUIRE(fault_of(checks, scene) == "");
  }
}

TEST_CASE("noise and checkerboards: meshers of polygons", "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 53);
  PolygonChecks checks;
  for (const ChunkShape shape :
       {ChunkShape::checkerboard, ChunkShape::noise, ChunkShape::uniform}) {
    for (const unsigned materials : {2u, 4u, kMeshMaterialCount}) {
      const Extent extent{33, 40, 31};
      MeshScene scene{random_chunk(rng, extent, random_order(rng), materials, shape), {}};
      for (auto& neighbour : scene.neighbours) {
        neighbour = random_chunk(rng, extent, random_order(rng), materials, shape);
      }
      CAPTURE(Catch::rngSeed(), static_cast<int>(shape), materials);
      REQUIRE(fault_of(checks, scene) == "");
    }
  }
  for (int round = 0; round < 10; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const MeshScene scene = scene_of_many_materials(rng, Extent{12, 9, 11});
    REQUIRE(checks.fault(scene, many_visibility(), many_materials(),
                         expected_faces(scene, many_materials())) == "");
  }
}

TEST_CASE("scenarios: meshers of polygons", "[mesh][property][polygons][scenarios]") {
  PolygonChecks checks;
  for (const unsigned edge : {8u, 32u, 64u}) {
    // Baselines of reports: every fourth scenario is enough at the largest edge.
    const unsigned step = edge < 64 ? 1 : std::max(4u, kLargeScenarioStep);
    for (unsigned number = 1; number <= 37; number += step) {
      if (number == 5 && edge != 32) continue;
      for (const bool alone : {true, false}) {
        const MeshScene scene =
            scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, alone);
        CAPTURE(edge, number, alone);
        REQUIRE(fault_of(checks, scene) == "");
      }
    }
  }
}

}  // namespace
}  // namespace runstone::test
