#include "tests/reference/run_strip_mesher.hpp"

#include <catch2/catch.hpp>

#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using namespace reference;

/// Returns stone along y from 1 to 6 at 3 3, and along x from 1 to 6 at y 3, z 5. Some faces of
/// each are hidden.
MeshScene beams() {
  MeshScene scene{uniform_chunk(Extent::cube(8), kEmpty), {}};
  const auto put = [&scene](std::uint8_t x, std::uint8_t y, std::uint8_t z, Material material) {
    fill(scene.chunk, index_of({x, y, z}, scene.chunk.extent, scene.chunk.order), 1, material);
  };
  for (std::uint8_t i = 1; i <= 6; ++i) {
    put(3, i, 3, kStone);
    put(i, 3, 5, kStone);
  }
  put(2, 1, 3, kDirt);  // hides -x of the upright beam's first voxel
  put(2, 4, 3, kDirt);  // hides -x of its fourth voxel
  put(5, 4, 5, kDirt);  // hides +y of the other beam's fifth voxel
  return scene;
}

std::vector<QuadFields> stone_quads(HiddenFaces hidden, Direction direction) {
  RunStripScratch scratch;
  std::vector<Quad> quads;
  mesh_run_strips(grid_of(beams()), mesh_visibility(), hidden, scratch, quads);
  std::vector<QuadFields> out;
  for (const Quad quad : quads) {
    const QuadFields q = unpack(quad);
    if (q.direction == direction && q.material == kStone) out.push_back(q);
  }
  return out;
}

TEST_CASE("run strips: sides run along y, and hidden faces end them", "[mesh][reference]") {
  const auto left = stone_quads(HiddenFaces::end_run, Direction::neg_x);
  // Two of the upright beam (u of an x face is y), and the end of the other.
  REQUIRE(left.size() == 3);
  CHECK(left[0] == QuadFields{3, 2, 3, 2, 1, Direction::neg_x, kStone});
  CHECK(left[1] == QuadFields{3, 5, 3, 2, 1, Direction::neg_x, kStone});
  CHECK(left[2] == QuadFields{1, 3, 5, 1, 1, Direction::neg_x, kStone});
}

TEST_CASE("run strips: tops run along x", "[mesh][reference]") {
  const auto up = stone_quads(HiddenFaces::end_run, Direction::pos_y);
  REQUIRE(up.size() == 3);  // v of a y face is x
  CHECK(up[0] == QuadFields{3, 6, 3, 1, 1, Direction::pos_y, kStone});
  CHECK(up[1] == QuadFields{1, 3, 5, 1, 4, Direction::pos_y, kStone});
  CHECK(up[2] == QuadFields{6, 3, 5, 1, 1, Direction::pos_y, kStone});
}

TEST_CASE("run strips as in the original begin at an exposed face and end with their material",
          "[mesh][reference]") {
  const auto left = stone_quads(HiddenFaces::run_on, Direction::neg_x);
  REQUIRE(left.size() == 2);
  CHECK(left[0] == QuadFields{3, 2, 3, 5, 1, Direction::neg_x, kStone});  // over the hidden fourth
  const auto up = stone_quads(HiddenFaces::run_on, Direction::pos_y);
  REQUIRE(up.size() == 2);
  CHECK(up[1] == QuadFields{1, 3, 5, 1, 6, Direction::pos_y, kStone});
}

TEST_CASE("run strips are never wider than a voxel, and never join across materials",
          "[mesh][reference]") {
  SplitMix64 rng(12);
  RunStripScratch scratch;
  std::vector<Quad> quads;
  for (int round = 0; round < 50; ++round) {
    const MeshScene scene = random_scene(rng, 16);
    const DenseChunk dense = DenseChunk::of(scene.chunk);
    for (const HiddenFaces hidden : {HiddenFaces::end_run, HiddenFaces::run_on}) {
      mesh_run_strips(grid_of(scene), mesh_visibility(), hidden, scratch, quads);
      const std::vector<UnitFace> exposed = expected_faces(scene);
      const std::vector<UnitFace> owed =
          hidden == HiddenFaces::run_on ? run_on_faces(dense, exposed) : exposed;
      REQUIRE(quads_difference(quads, scene.chunk.extent, mesh_materials(), owed).value_or("") ==
              "");
      int wide = 0;
      for (const Quad quad : quads) {
        const QuadFields q = unpack(quad);
        // y is u of x faces and v of z faces; x is v of y faces.
        wide += (axis_of(q.direction) == Axis::x ? q.height : q.width) != 1 ? 1 : 0;
      }
      REQUIRE(wide == 0);
    }
  }
}

}  // namespace
}  // namespace runstone::test
