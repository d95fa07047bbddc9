// The order of quads is guaranteed and the same for every compiler and instruction set. One digest
// covers the meshes of the scenarios, another those of the seeded worlds.
#include <catch2/catch.hpp>
#include <cstdint>

#include "bench/worlds/seeded_worlds.hpp"
#include "common/core/hash.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::test {
namespace {

constexpr unsigned kEdge = 32;

/// Digest of quads and starts of layers, in order.
class QuadDigest {
 public:
  void add(const MeshScene& scene, const VisibilityTable& visibility) {
    mesh_rdm(scene.chunk, scene.pointers(), visibility, scratch_, mesh_);
    for (const QuadLayers* pass : {&mesh_.opaque, &mesh_.transparent}) {
      for (const Quad quad : pass->quads) sum_ = mix64(sum_ ^ quad.bits);
      for (const std::uint32_t first : pass->first) sum_ = mix64(sum_ ^ first);
    }
  }
  std::uint64_t sum() const { return sum_; }

 private:
  RdmScratch scratch_;
  ChunkMesh mesh_;
  std::uint64_t sum_ = 0;
};

TEST_CASE("scenarios give the pinned quads in the pinned order", "[mesh][scenarios][golden]") {
  QuadDigest digest;
  for (unsigned number = 1; number <= 37; ++number) {
    const auto world = scenario_generator(number, kEdge);
    for (const bool alone : {true, false}) {
      digest.add(scenario_scene(*world, {0, 0, 0}, kEdge, alone), scenario_visibility());
    }
  }
  CHECK(digest.sum() == 0x5f66cd4cae17c38b);
}

TEST_CASE("seeded worlds give the pinned quads in the pinned order", "[mesh][golden]") {
  QuadDigest digest;
  for (const bench::VoxelWorld& world : bench::seeded_worlds()) {
    for (const bench::Volume& volume :
         bench::volumes_in(world, {{-32, -32, -32}, {32, 32, 32}}, kEdge)) {
      digest.add(volume.scene, *world.visibility);
    }
  }
  CHECK(digest.sum() == 0xed9c8493534f0b43);
}

}  // namespace
}  // namespace runstone::test
