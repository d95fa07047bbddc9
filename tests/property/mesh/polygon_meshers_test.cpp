// The meshers of polygons, monotone and Poly2Tri, before the triangle oracle: the exposed faces with material
// and direction, each covered once, and no vertices but corners of the faces' outlines.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <tuple>

#include "common/mesh/reference/monotone_mesher.hpp"
#include "common/mesh/reference/poly2tri_mesher.hpp"
#include "tests/support/mesh_scene.hpp"
#include "tests/support/random_chunk.hpp"
#include "tests/support/scenario_scene.hpp"
#include "tests/support/triangle_oracle.hpp"

namespace runstone::test {
namespace {

using namespace reference;

/// Both meshers, with buffers that live as long as the jury.
class PolygonJury {
 public:
  /// What is wrong with the first wrong mesh of a scene, and whose it is; nothing if all is well.
  std::string fault(const MeshScene& scene, const MaterialTable& materials = mesh_materials()) {
    const VisibilityTable visibility(materials);
    const std::vector<UnitFace> owed = expected_faces(scene, materials);
    const DenseGrid grid = grid_of(scene);
    mesh_monotone(grid, visibility, monotone_, mesh_);
    if (const auto wrong = triangles_difference(mesh_, scene.chunk.extent, materials, owed)) {
      return "monotone: " + *wrong;
    }
    triangles_ = mesh_.triangles.size();
    vertices_ = mesh_.vertices;
    mesh_poly2tri(grid, visibility, poly2tri_, mesh_);
    if (const auto wrong = triangles_difference(mesh_, scene.chunk.extent, materials, owed)) {
      return "poly2tri: " + *wrong;
    }
    // Any triangulation of a polygon without new points has as many triangles as any other.
    if (mesh_.triangles.size() != triangles_ || mesh_.vertices != vertices_)
      return "the meshers differ in size";
    return {};
  }
  std::size_t triangles() const { return triangles_; }
  std::size_t touching_corners() const { return poly2tri_.polygons.touching_corners; }

 private:
  MonotoneScratch monotone_;
  Poly2TriScratch poly2tri_;
  TriangleMesh mesh_;
  std::size_t triangles_ = 0;
  std::vector<MeshVertex> vertices_;
};

TEST_CASE("random scenes: meshers of polygons cover exactly the exposed faces",
          "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 51);
  PolygonJury jury;
  std::size_t touching = 0;
  for (int scene_number = 0; scene_number < 3000; ++scene_number) {
    const unsigned side_max = scene_number % 200 == 0 ? 40 : scene_number % 20 == 0 ? 20 : 10;
    const MeshScene scene = random_scene(rng, side_max);
    const std::string fault = jury.fault(scene);
    touching += jury.touching_corners();
    if (fault.empty()) continue;
    CAPTURE(Catch::rngSeed(), scene_number);
    FAIL(fault);
  }
  CHECK(touching > 500);
}

TEST_CASE("the largest and the flattest extents: meshers of polygons", "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 52);
  PolygonJury jury;
  for (const Extent extent :
       {Extent{128, 8, 8}, Extent{8, 128, 9}, Extent{10, 8, 128}, Extent{128, 128, 8}, Extent{65, 64, 63}}) {
    const MeshScene scene = scene_of_extent(rng, extent, random_order(rng));
    CAPTURE(Catch::rngSeed(), extent.x, extent.y, extent.z);
    REQUIRE(jury.fault(scene) == "");
  }
}

TEST_CASE("noise and checkerboards: meshers of polygons", "[mesh][property][polygons]") {
  SplitMix64 rng(Catch::rngSeed() + 53);
  PolygonJury jury;
  for (const Shape shape : {Shape::checkerboard, Shape::noise, Shape::uniform}) {
    for (const unsigned materials : {2u, 4u, kMeshMaterialCount}) {
      const Extent extent{33, 40, 31};
      MeshScene scene{random_chunk(rng, extent, random_order(rng), materials, shape), {}};
      for (auto& neighbour : scene.neighbours) {
        neighbour = random_chunk(rng, extent, random_order(rng), materials, shape);
      }
      CAPTURE(Catch::rngSeed(), static_cast<int>(shape), materials);
      REQUIRE(jury.fault(scene) == "");
    }
  }
  for (int round = 0; round < 10; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    REQUIRE(jury.fault(scene_of_many_materials(rng, Extent{12, 9, 11}), many_materials()) == "");
  }
}

TEST_CASE("scenarios: meshers of polygons", "[mesh][property][polygons][scenarios]") {
  PolygonJury jury;
  for (const unsigned edge : {8u, 32u, 64u}) {
    for (unsigned number = 1; number <= 37; ++number) {
      if (number == 5 && edge != 32) continue;
      for (const bool alone : {true, false}) {
        const MeshScene scene = scenario_scene(*scenario_generator(number, edge), {0, 0, 0}, edge, alone);
        CAPTURE(edge, number, alone);
        REQUIRE(jury.fault(scene) == "");
      }
    }
  }
}

}  // namespace
}  // namespace runstone::test
