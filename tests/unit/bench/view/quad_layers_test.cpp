#include "bench/view/quad_layers.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "bench/worlds/seeded_worlds.hpp"
#include "common/core/hash.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"

namespace runstone::bench {

TEST_CASE("quads in any order are sorted into the passes and layers of a mesh", "[view]") {
  const auto worlds = seeded_worlds();
  const auto world =
      std::find_if(worlds.begin(), worlds.end(), [](const auto& w) { return w.name == "terrain"; });
  REQUIRE(world != worlds.end());
  const RunChunk chunk = chunk_of_world(*world, {0, -16, 0}, 32);
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(chunk, {}, *world->visibility, scratch, mesh);
  REQUIRE_FALSE(mesh.opaque.quads.empty());
  REQUIRE_FALSE(mesh.transparent.quads.empty());

  std::vector<Quad> quads = mesh.opaque.quads;
  quads.insert(quads.end(), mesh.transparent.quads.begin(), mesh.transparent.quads.end());
  SplitMix64 rng(4);
  for (std::size_t i = quads.size(); i > 1; --i)
    std::swap(quads[i - 1], quads[rng.below(static_cast<std::uint32_t>(i))]);
  const ChunkMesh sorted = layered(quads, *world->visibility);
  CHECK(sorted.opaque.first == mesh.opaque.first);
  CHECK(sorted.transparent.first == mesh.transparent.first);
  for (int d = 0; d < kDirectionCount; ++d) {
    for (unsigned layer = 0; layer < 32; ++layer) {
      const auto of = [&](const QuadLayers& layers) {
        const auto span = layers.layer(static_cast<Direction>(d), layer);
        std::vector<std::uint64_t> out;
        for (const Quad quad : span) out.push_back(quad.bits);
        std::sort(out.begin(), out.end());
        return out;
      };
      CHECK(of(sorted.opaque) == of(mesh.opaque));
      CHECK(of(sorted.transparent) == of(mesh.transparent));
    }
  }
}

TEST_CASE("no quads are an empty mesh", "[view]") {
  const ChunkMesh mesh = layered({}, VisibilityTable(std::vector<Visibility>{}));
  CHECK(mesh.empty());
  CHECK(mesh.opaque.first == ChunkMesh{}.opaque.first);
}

}  // namespace runstone::bench
