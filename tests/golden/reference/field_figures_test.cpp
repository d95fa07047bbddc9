// The parts of the meshes of the 37 scenarios, as in docs/meshing.md: each chunk of edge 32 alone.
#include <array>
#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "bench/meshing/mesh_figures.hpp"
#include "bench/meshing/mesher_case.hpp"
#include "bench/worlds/measured_worlds.hpp"
#include "tests/reference/poly2tri_mesher.hpp"
#include "tests/support/scenarios/scenario_scene.hpp"

namespace runstone::test {
namespace {

constexpr unsigned kEdge = 32;

struct Sums {
  std::size_t triangles = 0, vertices = 0, t_junctions = 0, thin_16 = 0;
  friend bool operator==(const Sums&, const Sums&) = default;
};

TEST_CASE("the field over the 37 scenarios: triangles, vertices, T-junctions, thin triangles",
          "[mesh][scenarios][golden]") {
  const std::map<std::string, Sums> pinned = {
      {"culled", {1216076, 2432152, 0, 0}},
      {"decode_binary", {502022, 1004044, 54087, 752}},
      {"greedy", {501944, 1003888, 54318, 722}},
      {"grid_binary", {502022, 1004044, 54087, 752}},
      {"grid_rdm", {504848, 1009696, 53340, 860}},
      {"mask_binary", {502022, 1004044, 54087, 752}},
      {"monotone", {518132, 974513, 15884, 3897}},
      {"naive_greedy", {503018, 1006036, 55232, 776}},
      {"optimal_greedy", {500396, 1000792, 52855, 722}},
      {"padded_binary", {502022, 1004044, 54087, 752}},
      {"poly2tri", {518132, 974513, 15884, 672}},
      {"rdm", {504844, 1009688, 53569, 830}},
      {"rdm_kept", {504844, 1009688, 53569, 830}},
      {"rdm_plain", {504844, 1009688, 53569, 830}},
      {"rle_rdm", {1195306, 2390612, 82661, 73326}},
      {"run_strips", {569786, 1139572, 63048, 16054}},
      {"run_strips_hidden", {516282, 1032564, 96877, 22582}},
      {"simple", {7016940, 14033880, 0, 0}},
  };
  std::map<std::string, Sums> found;
  reference::Surface surface;
  for (unsigned number = 1; number <= 37; ++number) {
    bench::Volume volume;
    volume.edge = kEdge;
    volume.scene = scenario_scene(*scenario_generator(number, kEdge), {0, 0, 0}, kEdge, true);
    for (const std::string_view name : bench::mesher_case_names()) {
      const auto mesher_case = bench::make_mesher_case(name, volume, scenario_visibility());
      REQUIRE(mesher_case.has_value());
      bench::PhaseTimes phases{};
      mesher_case->mesh(phases);
      mesher_case->surface(surface);
      const bench::MeshFigures figures = bench::figures_of(surface);
      Sums& sums = found[std::string(name)];
      sums.triangles += figures.triangles;
      sums.vertices += figures.vertices;
      sums.t_junctions += figures.t_junctions.places;
      sums.thin_16 += figures.thin.above_16;
    }
  }
  for (const auto& [name, sums] : found) {
    CAPTURE(name, sums.triangles, sums.vertices, sums.t_junctions, sums.thin_16);
    const auto expected = pinned.find(name);
    CHECK((expected != pinned.end() && sums == expected->second));
  }
}

/// The regions of scenes that Poly2Tri's original rejects.
class TouchingRegions {
 public:
  void add(const MeshScene& scene, const VisibilityTable& visibility) {
    reference::mesh_poly2tri(grid_of(scene), visibility, scratch_, mesh_);
    regions += scratch_.polygons.regions;
    touching += scratch_.polygons.touching_regions;
    corners += scratch_.polygons.touching_corners;
  }
  std::size_t regions = 0, touching = 0, corners = 0;

 private:
  reference::Poly2TriScratch scratch_;
  reference::TriangleMesh mesh_;
};

TEST_CASE("the outlines of the scenarios count the regions that Poly2Tri's original rejects",
          "[mesh][scenarios][golden]") {
  TouchingRegions scenarios;
  for (unsigned number = 1; number <= 37; ++number) {
    scenarios.add(scenario_scene(*scenario_generator(number, kEdge), {0, 0, 0}, kEdge, true),
                  scenario_visibility());
  }
  CHECK(scenarios.regions == 228834);
  CHECK(scenarios.touching == 76);
  CHECK(scenarios.corners == 411);

  const std::map<std::string, std::array<std::size_t, 3>> pinned = {{"hills", {1238, 0, 0}},
                                                                    {"caves", {16096, 4, 4}},
                                                                    {"town", {3104, 0, 0}},
                                                                    {"luanti", {10649, 59, 97}}};
  const auto worlds = bench::MeasuredWorlds::open(
      {"hills", "caves", "town", "luanti"}, RUNSTONE_SOURCE_DIR "/tests/data/luanti_v7_small");
  REQUIRE(worlds.has_value());
  for (std::size_t w = 0; w < worlds->size(); ++w) {
    const bench::MeasuredWorld world = worlds->at_edge(w, kEdge);
    const auto volumes =
        world.name == "luanti"
            ? world.volumes
            : bench::volumes_in(*worlds->voxels(w), {{-32, -32, -32}, {32, 32, 32}}, kEdge);
    TouchingRegions found;
    for (const bench::Volume& volume : volumes) found.add(volume.scene, *world.visibility);
    CAPTURE(world.name, found.regions, found.touching, found.corners);
    CHECK(pinned.at(world.name) == std::array{found.regions, found.touching, found.corners});
  }
}

}  // namespace
}  // namespace runstone::test
