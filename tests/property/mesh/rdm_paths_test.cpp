// The vector paths of the layer sweep against the plain one: every instruction set this machine has must give
// the same quads in the same order.
#include <hwy/targets.h>

#include <catch2/catch.hpp>

#include "tests/support/mesh_scene.hpp"
#include "tests/support/random_chunk.hpp"

namespace runstone::test {
namespace {

void require_equal(const QuadLayers& a, const QuadLayers& b) {
  REQUIRE(a.quads == b.quads);
  REQUIRE(a.first == b.first);
}

TEST_CASE("every instruction set gives the quads of the plain path", "[mesh][property]") {
  SplitMix64 rng(Catch::rngSeed() + 7);
  std::vector<MeshScene> scenes;
  for (int i = 0; i < 400; ++i) scenes.push_back(random_scene(rng, i % 20 == 0 ? 64 : 20));
  RdmScratch plain_scratch;
  plain_scratch.use_plain_path(true);
  std::vector<ChunkMesh> plain(scenes.size());
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    mesh_rdm(scenes[i].chunk, scenes[i].pointers(), mesh_visibility(), plain_scratch, plain[i]);
  }
  const auto targets = hwy::SupportedAndGeneratedTargets();
  REQUIRE_FALSE(targets.empty());
  RdmScratch scratch;
  ChunkMesh mesh;
  for (const auto target : targets) {
    hwy::SetSupportedTargetsForTest(target);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      mesh_rdm(scenes[i].chunk, scenes[i].pointers(), mesh_visibility(), scratch, mesh);
      CAPTURE(Catch::rngSeed(), hwy::TargetName(target), i);
      require_equal(mesh.opaque, plain[i].opaque);
      require_equal(mesh.transparent, plain[i].transparent);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace runstone::test
