// The vector paths of the layer sweep are compared with the plain path. Every instruction set of
// this machine must give the same quads in the same order.
#include <hwy/targets.h>

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/support/mesh/equal_quads.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

struct Trial {
  MeshScene scene;
  const VisibilityTable* visibility;
  ChunkMesh plain;
  ChunkBorders borders;
  void mesh(RdmScratch& scratch, ChunkMesh& out, ChunkBorders& chunk_borders) const {
    mesh_rdm(scene.chunk, scene.pointers(), MeshBorders{}, *visibility, scratch, out,
             &chunk_borders);
  }
};

TEST_CASE("every instruction set gives the quads and the borders of the plain path",
          "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 7);
  std::vector<Trial> trials;
  for (int i = 0; i < 400; ++i) {
    const unsigned side_max = i % 20 == 0 ? 64 : i % 20 == 10 ? 128 : 20;
    trials.push_back({random_scene(rng, side_max), &mesh_visibility(), {}, {}});
  }
  for (const Extent extent : {Extent{12, 9, 11}, Extent{32, 8, 17}, Extent{64, 8, 33},
                              Extent{65, 9, 12}, Extent{8, 128, 10}}) {
    for (int i = 0; i < 5; ++i) {
      trials.push_back({scene_of_many_materials(rng, extent), &many_visibility(), {}, {}});
    }
  }
  RdmScratch plain_scratch;
  plain_scratch.use_plain_path(true);
  for (Trial& trial : trials) trial.mesh(plain_scratch, trial.plain, trial.borders);
  const auto targets = hwy::SupportedAndGeneratedTargets();
  REQUIRE_FALSE(targets.empty());
  RdmScratch scratch;
  ChunkMesh mesh;
  ChunkBorders borders;
  for (const auto target : targets) {
    hwy::SetSupportedTargetsForTest(target);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      trials[i].mesh(scratch, mesh, borders);
      CAPTURE(Catch::rngSeed(), hwy::TargetName(target), i);
      require_equal(mesh.opaque, trials[i].plain.opaque);
      require_equal(mesh.transparent, trials[i].plain.transparent);
      REQUIRE(equal_borders(trials[i].scene.chunk, borders, trials[i].borders));
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

#if HWY_ARCH_X86_64
TEST_CASE("every build runs vector code, those with sanitizers too", "[mesh][property]") {
  const auto targets = hwy::SupportedAndGeneratedTargets();
  CHECK(std::any_of(targets.begin(), targets.end(),
                    [](auto target) { return target != HWY_SCALAR && target != HWY_EMU128; }));
}
#endif

}  // namespace
}  // namespace runstone::test
