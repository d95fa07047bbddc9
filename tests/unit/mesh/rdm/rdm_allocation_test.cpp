// The promise of RdmScratch: once its buffers and the output's have grown, meshing allocates nothing. Counted
// by the global operator new of this test program.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/support/mesh_scene.hpp"

namespace {
std::size_t allocations = 0;  // test programs are single-threaded
}  // namespace

void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
void* operator new(std::size_t size) {
  if (void* const memory = operator new(size, std::nothrow)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace runstone::test {
namespace {

TEST_CASE("meshing allocates nothing once scratch and output have grown", "[mesh]") {
  SplitMix64 rng(23);
  std::vector<MeshScene> scenes;
  for (int i = 0; i < 40; ++i) scenes.push_back(random_scene(rng, 20));
  RdmScratch scratch;
  ChunkMesh mesh;
  const VisibilityTable& visibility = mesh_visibility();
  for (const bool grown : {false, true}) {
    const std::size_t before = allocations;
    for (const MeshScene& scene : scenes) mesh_rdm(scene.chunk, scene.pointers(), visibility, scratch, mesh);
    if (grown) {
      CHECK(allocations == before);
    } else {
      CHECK(allocations > before);  // the counter counts
    }
  }
}

TEST_CASE("remeshing layers allocates nothing once scratch and mesh have grown", "[mesh]") {
  SplitMix64 rng(24);
  MeshScene scene = random_scene(rng, 32);
  RdmScratch scratch;
  ChunkMesh mesh;
  const VisibilityTable& visibility = mesh_visibility();
  mesh_rdm(scene.chunk, scene.pointers(), visibility, scratch, mesh);
  // A voxel that comes and goes; the swap of buffers takes two rounds to grow both.
  const std::uint32_t voxel = scene.chunk.volume() / 2;
  const LocalPos at = pos_of(voxel, scene.chunk.extent, scene.chunk.order);
  DirtyLayers dirty;
  dirty.layer[0].set(at.x);
  dirty.layer[1].set(at.y);
  dirty.layer[2].set(at.z);
  std::size_t counted = 0;
  for (int round = 0; round < 12; ++round) {
    fill(scene.chunk, voxel, 1, round % 2 == 0 ? kStone : kWater);
    const std::size_t before = allocations;
    mesh_rdm_layers(scene.chunk, scene.pointers(), visibility, dirty, {}, scratch, mesh);
    counted = allocations - before;
  }
  CHECK(counted == 0);
}

}  // namespace
}  // namespace runstone::test
