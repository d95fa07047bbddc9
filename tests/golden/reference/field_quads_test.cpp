// The quads that each mesher makes of the same worlds, as in docs/meshing.md: the 37 scenarios
// alone, and eight chunks of edge 32 in the middle of seeded worlds.
#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "bench/worlds/seeded_worlds.hpp"
#include "tests/reference/binary_greedy.hpp"
#include "tests/reference/culled_mesher.hpp"
#include "tests/reference/greedy_mesher.hpp"
#include "tests/reference/grid_rdm.hpp"
#include "tests/reference/naive_greedy_mesher.hpp"
#include "tests/reference/optimal_greedy_mesher.hpp"
#include "tests/reference/run_strip_mesher.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;

constexpr unsigned kFieldEdge = 32;

struct Counts {
  std::size_t optimal, greedy, binary, naive, rdm, grid_rdm, strips, strips_hidden;
  std::size_t culled;        // one a face
  std::size_t hidden_faces;  // drawn by strips_hidden
  friend bool operator==(const Counts&, const Counts&) = default;
};

std::string text_of(const Counts& c) {
  std::string out;
  for (const std::size_t count : {c.optimal, c.greedy, c.binary, c.naive, c.rdm, c.grid_rdm,
                                  c.strips, c.strips_hidden, c.culled, c.hidden_faces}) {
    out += std::to_string(count) + ", ";
  }
  return out;
}

/// Adds the quads that all meshers make of a scene.
class Field {
 public:
  void add(const MeshScene& scene, const VisibilityTable& visibility) {
    const DenseGrid grid = grid_of(scene);
    const auto count = [this](std::size_t& sum) { sum += quads_.size(); };
    mesh_optimal_greedy(grid, visibility, optimal_, quads_);
    count(counts_.optimal);
    mesh_greedy(grid, visibility, greedy_, quads_);
    count(counts_.greedy);
    mesh_naive_greedy(grid, visibility, naive_, quads_);
    count(counts_.naive);
    mesh_grid_rdm(grid, visibility, grid_rdm_, quads_);
    count(counts_.grid_rdm);
    mesh_run_strips(grid, visibility, HiddenFaces::end_run, strips_, quads_);
    count(counts_.strips);
    mesh_run_strips(grid, visibility, HiddenFaces::run_on, strips_, quads_);
    count(counts_.strips_hidden);
    for (const Quad quad : quads_)
      counts_.hidden_faces += std::size_t{unpack(quad).width} * unpack(quad).height;
    mesh_culled(grid, visibility, quads_);
    count(counts_.culled);
    counts_.hidden_faces -= quads_.size();
    mesh_binary_greedy(grid, visibility, binary_, mesh_);
    counts_.binary += mesh_.quad_count();
    mesh_rdm(scene.chunk, scene.pointers(), visibility, rdm_, mesh_);
    counts_.rdm += mesh_.quad_count();
  }
  const Counts& counts() const { return counts_; }

 private:
  OptimalGreedyScratch optimal_;
  GreedyScratch greedy_;
  NaiveGreedyScratch naive_;
  GridRdmScratch grid_rdm_;
  RunStripScratch strips_;
  BinaryScratch binary_;
  RdmScratch rdm_;
  std::vector<Quad> quads_;
  ChunkMesh mesh_;
  Counts counts_{};
};

TEST_CASE("the field over the 37 scenarios makes the quads that the page says",
          "[mesh][scenarios][golden]") {
  Field field;
  for (unsigned number = 1; number <= 37; ++number) {
    field.add(scenario_scene(*scenario_generator(number, kFieldEdge), {0, 0, 0}, kFieldEdge, true),
              scenario_visibility());
  }
  INFO(text_of(field.counts()));
  CHECK(field.counts() ==
        Counts{250198, 250972, 251011, 251509, 252422, 252424, 284893, 258141, 608038, 166302});
}

TEST_CASE("the field over seeded worlds makes the quads that the page says", "[mesh][golden]") {
  const std::map<std::string, Counts> pinned = {
      {"hills", {1851, 1895, 1892, 1870, 1891, 1900, 3215, 3215, 6088, 0}},
      {"caves", {21955, 22213, 22226, 22439, 22663, 22706, 32752, 29962, 61180, 123030}},
      {"town", {4550, 4730, 4786, 4746, 4830, 4848, 10120, 8280, 30770, 6588}},
  };
  std::size_t met = 0;
  for (const bench::VoxelWorld& world : bench::seeded_worlds()) {
    const auto expected = pinned.find(world.name);
    if (expected == pinned.end()) continue;
    ++met;
    Field field;
    for (const bench::Volume& volume :
         bench::volumes_in(world, {{-32, -32, -32}, {32, 32, 32}}, kFieldEdge)) {
      field.add(volume.scene, *world.visibility);
    }
    INFO(world.name << ": " << text_of(field.counts()));
    CHECK(field.counts() == expected->second);
  }
  CHECK(met == pinned.size());
}

}  // namespace
}  // namespace runstone::test
