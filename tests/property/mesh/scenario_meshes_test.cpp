// The thesis' 37 scenarios at every edge, before the same jury as random chunks: how many quads a mesher
// needs is in tests/golden/scenarios, whether they are the right ones is here.
#include <catch2/catch.hpp>
#include <span>
#include <vector>

#include "common/mesh/reference/culled_mesher.hpp"
#include "tests/support/mesher_jury.hpp"
#include "tests/support/scenario_scene.hpp"

namespace runstone::test {
namespace {

std::size_t area_of(std::span<const Quad> quads) {
  std::size_t area = 0;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    area += std::size_t{q.width} * q.height;
  }
  return area;
}

TEST_CASE("scenarios alone mesh to the faces each mesher owes", "[mesh][property][scenarios]") {
  MesherJury jury;
  for (const unsigned edge : {8u, 16u, 32u}) {
    for (unsigned number = 1; number <= 37; ++number) {
      if (number == 5 && edge != 32) continue;
      const MeshScene scene = scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
      CAPTURE(edge, number);
      REQUIRE(jury.fault(scene) == "");
      const ChunkMesh ours = mesh_of(scene);
      CHECK(scene_difference(scene, ours).value_or("") == "");
      CHECK(ours.quad_count() <= jury.culled_quads());
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
      CHECK(scene_difference(scene, mesh_of(scene)).value_or("") == "");
    }
  }
}

TEST_CASE("large scenarios cover as much area merged as culled", "[mesh][property][scenarios]") {
  // Face by face takes too long here; each mesher was held to its faces above.
  std::vector<Quad> quads;
  reference::GridRdmScratch grid_rdm;
  reference::BinaryScratch binary;
  ChunkMesh mesh;
  for (const unsigned edge : {64u, 128u}) {
    for (unsigned number = 1; number <= 37; ++number) {
      if (number == 5) continue;
      const MeshScene scene = scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, true);
      const reference::DenseGrid grid = grid_of(scene);
      CAPTURE(edge, number);
      reference::mesh_culled(grid, mesh_visibility(), quads);
      const std::size_t faces = quads.size();
      reference::mesh_grid_rdm(grid, mesh_visibility(), grid_rdm, quads);
      CHECK(area_of(quads) == faces);
      CHECK(quads.size() <= faces);
      const ChunkMesh ours = mesh_of(scene);
      CHECK(area_of(ours.opaque.quads) == faces);
      CHECK(ours.quad_count() <= faces);
      if (edge > reference::kBinarySideMax) continue;
      reference::mesh_binary_greedy(grid, mesh_visibility(), binary, mesh);
      CHECK(area_of(mesh.opaque.quads) == faces);
      CHECK(mesh.quad_count() <= faces);
    }
  }
}

}  // namespace
}  // namespace runstone::test
