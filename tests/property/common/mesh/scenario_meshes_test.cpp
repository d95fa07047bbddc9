// The thesis' 37 scenarios at every edge, before the same jury as random chunks: how many quads a mesher
// needs is in tests/golden/scenarios, whether they are the right ones is here.
#include <catch2/catch.hpp>
#include <string>

#include "tests/support/mesher_checks.hpp"
#include "tests/support/scenario_scene.hpp"

namespace runstone::test {
namespace {

TEST_CASE("scenarios alone mesh to the faces each mesher owes", "[mesh][property][scenarios]") {
  MesherJury jury;
  for (const unsigned edge : {8u, 16u, 32u}) {
    for (unsigned number = 1; number <= 37; ++number) {
      if (number == 5 && edge != 32) continue;
      const MeshScene scene =
          scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
      CAPTURE(edge, number);
      REQUIRE(jury.fault(scene) == "");
      const ChunkMesh ours = mesh_of(scene);
      CHECK(scene_difference(scene, ours).value_or("") == "");
      CHECK(ours.quad_count() <= jury.culled_quads());
      CHECK(ours.quad_count() >= jury.optimal_quads());
    }
  }
}

TEST_CASE("scenarios in their world of 27 chunks mesh to the faces each mesher owes",
          "[mesh][property][scenarios]") {
  // One chunk of each kind of place: in the middle, on a side, on an edge, in a corner.
  MesherJury jury;
  for (unsigned number = 1; number <= 37; ++number) {
    const auto world = scenario_generator(number, 32);
    for (const ChunkCoord at :
         {ChunkCoord{0, 0, 0}, ChunkCoord{0, 1, 0}, ChunkCoord{-1, 0, 1}, ChunkCoord{1, 1, -1}}) {
      const MeshScene scene = scenario_scene(*world, at, 32, false);
      CAPTURE(number, at.x, at.y, at.z);
      REQUIRE(jury.fault(scene) == "");
      const ChunkMesh ours = mesh_of(scene);
      CHECK(mesh_difference(ours, scene.chunk.extent, mesh_materials(), jury.exposed())
                .value_or("") == "");
      CHECK(ours.quad_count() >= jury.optimal_quads());
    }
  }
}

/// Of ours and of those before the jury (`fault`, a member of it).
void judge_large_scenarios(unsigned edge, std::string (MesherJury::*fault)(const MeshScene&)) {
  MesherJury jury;
  for (unsigned number = 1; number <= 37; ++number) {
    if (number == 5) continue;
    const MeshScene scene =
        scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
    CAPTURE(edge, number);
    REQUIRE((jury.*fault)(scene) == "");
    const ChunkMesh ours = mesh_of(scene);
    CHECK(
        mesh_difference(ours, scene.chunk.extent, mesh_materials(), jury.exposed()).value_or("") ==
        "");
    CHECK(ours.quad_count() <= jury.culled_quads());
    CHECK(ours.quad_count() >= jury.optimal_quads());
  }
}

TEST_CASE("scenarios of edge 64 alone mesh to the faces each mesher owes",
          "[mesh][property][scenarios]") {
  judge_large_scenarios(64, &MesherJury::fault);
}

TEST_CASE("scenarios of edge 128 alone mesh to their faces", "[mesh][property][scenarios]") {
  // The meshers that show hidden faces were held to theirs at smaller edges: they take a minute here.
  judge_large_scenarios(128, &MesherJury::fault_of_exposed);
}

TEST_CASE("large scenarios in the middle of their world mesh to their faces",
          "[mesh][property][scenarios]") {
  for (const unsigned edge : {64u, 128u}) {
    for (unsigned number = 1; number <= 37; ++number) {
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
