// T-junctions and thin triangles: by hand, and compared with plain loops over everything.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "common/mesh/quad_corners.hpp"
#include "tests/reference/t_junctions.hpp"
#include "tests/reference/thin_triangles.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

using namespace reference;

Surface surface_of(const ChunkMesh& mesh) {
  Surface out;
  out.quads = mesh.opaque.quads;
  out.quads.insert(out.quads.end(), mesh.transparent.quads.begin(), mesh.transparent.quads.end());
  return out;
}

TEST_CASE("a vertex inside an edge is a T-junction, vertices that meet are none",
          "[mesh][reference]") {
  Surface surface;
  surface.quads = {pack({0, 0, 0, 2, 2, Direction::pos_z, kStone}),
                   pack({2, 0, 0, 2, 2, Direction::pos_z, kStone})};
  CHECK(count_t_junctions(surface).places == 0);
  // The quad on the right is divided in two: the common corner lies in the middle of the left
  // quad's edge.
  surface.quads = {pack({0, 0, 0, 2, 2, Direction::pos_z, kStone}),
                   pack({2, 0, 0, 2, 1, Direction::pos_z, kStone}),
                   pack({2, 1, 0, 2, 1, Direction::pos_z, kStone})};
  CHECK(count_t_junctions(surface).places == 1);
  CHECK(count_t_junctions(surface).edges == 1);
  // Across directions: a side of 1 x 1 ends in the middle of the edge of the top, 2 x 2. Edges of
  // both count.
  surface.quads = {pack({0, 0, 0, 2, 2, Direction::pos_z, kStone}),
                   pack({1, 0, 0, 1, 1, Direction::pos_x, kStone})};
  CHECK(count_t_junctions(surface).places == 1);
  surface.quads.push_back(
      pack({2, 0, 0, 2, 2, Direction::pos_z, kDirt}));  // its edge contains the same point
  CHECK(count_t_junctions(surface).places == 1);
  CHECK(count_t_junctions(surface).edges == 2);
  // A vertex on the diagonal of a quad does not count; a vertex on the edge of a triangle does.
  surface.clear();
  surface.quads = {pack({0, 0, 0, 3, 3, Direction::pos_z, kStone}),
                   pack({1, 1, 1, 1, 1, Direction::neg_z, kWater})};
  CHECK(count_t_junctions(surface).places == 0);
  surface.clear();
  surface.triangles.vertices = {{0, 0, 1}, {2, 2, 1}, {0, 2, 1}, {1, 1, 1}, {2, 1, 1}, {2, 2, 1}};
  surface.triangles.triangles = {{{0, 1, 2}, Direction::pos_z, kStone},
                                 {{3, 4, 5}, Direction::pos_z, kStone}};
  CHECK(count_t_junctions(surface).places == 1);
  CHECK(count_t_junctions({}).places == 0);
}

/// Compares every vertex with every edge.
TJunctions t_junctions_by_pairs(const Surface& surface) {
  std::vector<std::vector<Corner>> polygons;
  for (const Quad quad : surface.quads) {
    const auto corners = quad_corners(quad);
    polygons.emplace_back(corners.begin(), corners.end());
  }
  for (const MeshTriangle& triangle : surface.triangles.triangles) {
    auto& corners = polygons.emplace_back();
    for (const std::uint32_t i : triangle.vertices) {
      const MeshVertex& v = surface.triangles.vertices[i];
      corners.push_back({v.x, v.y, v.z});
    }
  }
  std::set<Corner> vertices, places;
  for (const auto& polygon : polygons) vertices.insert(polygon.begin(), polygon.end());
  TJunctions out;
  for (const auto& polygon : polygons) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Corner& a = polygon[i];
      const Corner& b = polygon[(i + 1) % polygon.size()];
      for (const Corner& p : vertices) {
        const auto along = [&](const Corner& q) {
          return std::sqrt(std::pow(q[0] - p[0], 2) + std::pow(q[1] - p[1], 2) +
                           std::pow(q[2] - p[2], 2));
        };
        const double detour = along(a) + along(b) -
                              std::sqrt(std::pow(a[0] - b[0], 2) + std::pow(a[1] - b[1], 2) +
                                        std::pow(a[2] - b[2], 2));
        if (p == a || p == b || detour > 1e-9) continue;
        ++out.edges;
        places.insert(p);
      }
    }
  }
  out.places = places.size();
  return out;
}

TEST_CASE("T-junctions of random meshes are those found pair by pair", "[mesh][reference]") {
  SplitMix64 rng(41);
  std::size_t found = 0;
  for (int round = 0; round < 30; ++round) {
    Surface surface = surface_of(mesh_of(random_scene(rng, 9)));
    if (surface.quads.size() > 400) surface.quads.resize(400);
    if (round % 2 == 1) {  // any triangles at all
      surface.clear();
      for (std::uint32_t i = 0; i < 60; ++i) {
        for (int c = 0; c < 3; ++c) {
          surface.triangles.vertices.push_back({static_cast<std::uint8_t>(rng.below(9)),
                                                static_cast<std::uint8_t>(rng.below(9)),
                                                static_cast<std::uint8_t>(120 + rng.below(9))});
        }
        surface.triangles.triangles.push_back(
            {{3 * i, 3 * i + 1, 3 * i + 2}, Direction::pos_x, kStone});
      }
    }
    const TJunctions counted = count_t_junctions(surface);
    const TJunctions pairs = t_junctions_by_pairs(surface);
    CAPTURE(round);
    REQUIRE(counted.places == pairs.places);
    REQUIRE(counted.edges == pairs.edges);
    found += counted.places;
  }
  CHECK(found > 500);
}

TEST_CASE("thin triangles are counted beyond 1:16 and 1:100", "[mesh][reference]") {
  const auto count = [](unsigned width, unsigned height) {
    Surface surface;
    surface.quads = {pack({0, 0, 0, static_cast<std::uint8_t>(width),
                           static_cast<std::uint8_t>(height), Direction::neg_y, kStone})};
    const ThinTriangles thin = count_thin_triangles(surface);
    return std::pair(thin.above_16, thin.above_100);
  };
  using Pair = std::pair<std::size_t, std::size_t>;
  CHECK(count(1, 1) == Pair{0, 0});
  CHECK(count(15, 1) == Pair{0, 0});
  // The diagonal is a little longer than 16, and the height is less than 1.
  CHECK(count(1, 16) == Pair{2, 0});
  CHECK(count(2, 31) == Pair{0, 0});
  CHECK(count(99, 1) == Pair{2, 0});
  CHECK(count(1, 100) == Pair{2, 2});
  CHECK(count(128, 128) == Pair{0, 0});
  Surface surface;  // the square of the length over twice the area: exactly 16
  surface.triangles.vertices = {{0, 0, 5}, {8, 8, 5}, {4, 5, 5}, {5, 3, 5}, {5, 4, 5}};
  surface.triangles.triangles = {{{0, 1, 2}, Direction::pos_z, kStone}};  // 128 over 8
  CHECK(count_thin_triangles(surface).above_16 == 0);
  surface.triangles.triangles = {{{0, 1, 4}, Direction::pos_z, kStone}};  // the same below the line
  CHECK(count_thin_triangles(surface).above_16 == 0);
  surface.triangles.vertices[1] = {9, 8, 5};  // 145 over 4
  CHECK(count_thin_triangles(surface).above_16 == 1);
}

}  // namespace
}  // namespace runstone::test
