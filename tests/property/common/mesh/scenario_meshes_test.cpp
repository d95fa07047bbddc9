// The thesis' 37 scenarios at every edge, with the same checks as random chunks.
// tests/golden/reference pins the number of quads; these tests check that the quads are correct.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "tests/support/mesh/mesher_checks.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("scenarios alone mesh to the faces required of each mesher",
          "[mesh][property][scenarios]") {
  MesherChecks checks;
  for (const unsigned edge : {8u, 16u, 32u}) {
    for (unsigned number = 1; number <= 37; ++number) {
      if (number == 5 && edge != 32) continue;
      const MeshScene scene =
          scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
      CAPTURE(edge, number);
      REQUIRE(checks.fault(scene) == "");
      const ChunkMesh ours = mesh_of(scene);
      CHECK(scene_difference(scene, ours).value_or("") == "");
      CHECK(ours.quad_count() <= checks.culled_quads());
      CHECK(ours.quad_count() >= checks.optimal_quads());
    }
  }
}

TEST_CASE("scenarios in their world of 27 chunks mesh to the faces required of each mesher",
          "[mesh][property][scenarios]") {
  // The chunks are one of each kind of place: in the middle, on a side, on an edge, in a corner.
  MesherChecks checks;
  for (unsigned number = 1; number <= 37; ++number) {
    const auto world = scenario_generator(number, 32);
    for (const ChunkCoord at :
         {ChunkCoord{0, 0, 0}, ChunkCoord{0, 1, 0}, ChunkCoord{-1, 0, 1}, ChunkCoord{1, 1, -1}}) {
      const MeshScene scene = scenario_scene(*world, at, 32, false);
      CAPTURE(number, at.x, at.y, at.z);
      REQUIRE(checks.fault(scene) == "");
      const ChunkMesh ours = mesh_of(scene);
      CHECK(mesh_difference(ours, scene.chunk.extent, mesh_materials(), checks.exposed())
                .value_or("") == "");
      CHECK(ours.quad_count() >= checks.optimal_quads());
    }
  }
}

/// Returns the distance between two scenarios that are checked. A scenario of edge 128 costs eight
/// times one of edge 64, at which every scenario is checked.
unsigned scenario_step(unsigned edge) {
  return edge > 64 ? std::max(3u, kLargeScenarioStep) : kLargeScenarioStep;
}

/// Checks RDM and the reference meshers that `fault` covers.
void judge_large_scenarios(unsigned edge, std::string (MesherChecks::*fault)(const MeshScene&)) {
  MesherChecks checks;
  for (unsigned number = 1; number <= 37; number += scenario_step(edge)) {
    if (number == 5) continue;
    const MeshScene scene =
        scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
    CAPTURE(edge, number);
    REQUIRE((checks.*fault)(scene) == "");
    const ChunkMesh ours = mesh_of(scene);
    CHECK(mesh_difference(ours, scene.chunk.extent, mesh_materials(), checks.exposed())
              .value_or("") == "");
    CHECK(ours.quad_count() <= checks.culled_quads());
    CHECK(ours.quad_count() >= checks.optimal_quads());
  }
}

TEST_CASE("scenarios of edge 64 alone mesh to the faces required of each mesher",
          "[mesh][property][scenarios]") {
  judge_large_scenarios(64, &MesherChecks::fault);
}

TEST_CASE("scenarios of edge 128 alone mesh to their faces", "[mesh][property][scenarios]") {
  // Meshers that draw hidden faces are checked at smaller edges: they take a minute here.
  judge_large_scenarios(128, &MesherChecks::fault_of_exposed);
}

TEST_CASE("large scenarios in the middle of their world mesh to their faces",
          "[mesh][property][scenarios]") {
  for (const unsigned edge : {64u, 128u}) {
    for (unsigned number = 1; number <= 37; number += scenario_step(edge)) {
      if (number == 5) continue;
      const MeshScene scene =
          scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, false);
      CAPTURE(edge, number);
      CHECK(scene_difference(scene, mesh_of(scene)).value_or("") == "");
    }
  }
}

}  // namespace
}  // namespace runstone::test
