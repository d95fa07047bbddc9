#include "common/mesh/rdm/mesh_run.hpp"

#include <catch2/catch.hpp>

#include "common/runs/dense.hpp"
#include "tests/support/dense_chunk.hpp"
#include "tests/support/mesh_scene.hpp"
#include "tests/support/random_chunk.hpp"

namespace runstone::test {
namespace {

TEST_CASE("runs of every layer are its voxels in every orientation", "[mesh]") {
  SplitMix64 rng(41);
  std::vector<Material> layer;
  std::vector<rdm::MeshRun> runs;
  for (int round = 0; round < 60; ++round) {
    const RunChunk chunk =
        random_chunk(rng, random_extent(rng, 20), kAxisOrders[static_cast<std::size_t>(round % 6)], 5);
    const DenseChunk dense = DenseChunk::of(chunk);
    const auto sides = chunk.extent.sides();
    for (unsigned a = 0; a < 3; ++a) {
      for (unsigned u = 0; u < 3; ++u) {
        if (u == a) continue;
        const unsigned v = 3 - a - u;
        for (const unsigned at : {0u, sides[a] / 2u, sides[a] - 1u}) {
          rdm::layer_runs(chunk, static_cast<Axis>(a), at, static_cast<Axis>(u), mesh_visibility(), layer,
                          runs);
          REQUIRE(runs.back().end == static_cast<std::uint32_t>(sides[u]) * sides[v]);
          std::size_t run = 0;
          std::size_t wrong = 0;
          for (std::uint32_t i = 0; i < runs.back().end; ++i) {
            while (runs[run].end <= i) ++run;
            std::array<int, 3> p{};
            p[a] = static_cast<int>(at);
            p[u] = static_cast<int>(i % sides[u]);
            p[v] = static_cast<int>(i / sides[u]);
            wrong += runs[run].material != dense.at(p[0], p[1], p[2]) ? 1 : 0;
            wrong += runs[run].visibility != mesh_visibility()[runs[run].material] ? 1 : 0;
          }
          CAPTURE(round, a, u, at);
          CHECK(wrong == 0);
          for (std::size_t i = 1; i < runs.size(); ++i) REQUIRE(runs[i].material != runs[i - 1].material);
        }
      }
    }
  }
}

TEST_CASE("meshing makes no dense expansion", "[mesh]") {
  SplitMix64 rng(42);
  for (int round = 0; round < 30; ++round) {
    const MeshScene scene = random_scene(rng, 16);
    const std::uint64_t before = dense_expansions();
    mesh_of(scene);
    CHECK(dense_expansions() == before);
  }
}

}  // namespace
}  // namespace runstone::test
