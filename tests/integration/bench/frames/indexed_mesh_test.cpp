// The uploaded mesh is the mesher's mesh: every polygon, wound to the outside, with its normal and
// material.
#include "bench/frames/indexed_mesh.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <set>

#include "common/core/hash.hpp"

using namespace runstone;
using namespace runstone::bench;
using reference::MeshTriangle;
using reference::Surface;

namespace {

/// Returns twice the area of triangle `t`, by axis; positive where it is seen from that side.
std::array<int, 3> doubled_area(const IndexedMesh& mesh, std::size_t t) {
  std::array<std::array<int, 3>, 3> at{};
  for (std::size_t i = 0; i < 3; ++i) {
    const IndexedVertex& v = mesh.vertices.at(mesh.indices.at(3 * t + i));
    at[i] = {v.x, v.y, v.z};
  }
  std::array<int, 3> out{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    out[axis] = (at[1][u] - at[0][u]) * (at[2][v] - at[0][v]) -
                (at[1][v] - at[0][v]) * (at[2][u] - at[0][u]);
  }
  return out;
}

}  // namespace

TEST_CASE("a quad becomes two triangles of its area, direction and material", "[frames]") {
  SplitMix64 rng(1);
  for (int round = 0; round < 300; ++round) {
    QuadFields fields;
    fields.x = static_cast<std::uint8_t>(rng.below(64));
    fields.y = static_cast<std::uint8_t>(rng.below(64));
    fields.z = static_cast<std::uint8_t>(rng.below(64));
    fields.width = static_cast<std::uint8_t>(1 + rng.below(64));
    fields.height = static_cast<std::uint8_t>(1 + rng.below(64));
    fields.direction = static_cast<Direction>(rng.below(6));
    fields.material = static_cast<Material>(1 + rng.below(65535));
    const Surface surface{{pack({1, 2, 3, 4, 5, Direction::neg_y, 6}), pack(fields)}, {}};
    IndexedMesh mesh;
    index_surface(surface, mesh);
    REQUIRE(mesh.vertices.size() == 8);
    REQUIRE(mesh.indices.size() == 12);
    CHECK(mesh.byte_size() == 8 * 8 + 12 * 4);
    CAPTURE(round);
    const auto axis = static_cast<std::size_t>(axis_of(fields.direction));
    const int sign = is_positive(fields.direction) ? 1 : -1;
    std::array<int, 3> area{};
    std::set<std::uint32_t> used;
    for (const std::size_t t : {2u, 3u}) {
      const auto doubled = doubled_area(mesh, t);
      for (std::size_t a = 0; a < 3; ++a) area[a] += doubled[a];
      CHECK(doubled[axis] * sign > 0);
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t vertex = mesh.indices[3 * t + i];
        used.insert(vertex);
        CHECK(mesh.vertices[vertex].direction == fields.direction);
        CHECK(mesh.vertices[vertex].material == fields.material);
      }
    }
    CHECK(used == std::set<std::uint32_t>{4, 5, 6, 7});
    std::array<int, 3> owed{};
    owed[axis] = sign * 2 * fields.width * fields.height;
    CHECK(area == owed);
  }
}

TEST_CASE("a triangle mesh keeps its vertices shared, behind those of quads", "[frames]") {
  Surface surface;
  surface.quads = {pack({0, 0, 0, 1, 1, Direction::pos_x, 9})};
  surface.triangles.vertices = {{0, 4, 0}, {0, 4, 128}, {128, 4, 0},
                                {0, 5, 0}, {0, 5, 1},   {1, 5, 0}};
  surface.triangles.triangles = {MeshTriangle{{0, 1, 2}, Direction::pos_y, 300},
                                 MeshTriangle{{2, 1, 0}, Direction::pos_y, 300},
                                 MeshTriangle{{3, 4, 5}, Direction::neg_y, 2}};
  IndexedMesh mesh;
  mesh.vertices.resize(3);  // the remains of another mesh
  mesh.indices.resize(1);
  index_surface(surface, mesh);
  REQUIRE(mesh.vertices.size() == surface.vertex_count());
  REQUIRE(mesh.indices.size() == 3 * surface.triangle_count());
  CHECK(std::vector<std::uint32_t>(mesh.indices.begin() + 6, mesh.indices.end()) ==
        std::vector<std::uint32_t>{4, 5, 6, 6, 5, 4, 7, 8, 9});
  CHECK(mesh.vertices[5] == IndexedVertex{0, 4, 128, Direction::pos_y, 300});
  CHECK(mesh.vertices[6] == IndexedVertex{128, 4, 0, Direction::pos_y, 300});
  CHECK(mesh.vertices[9] == IndexedVertex{1, 5, 0, Direction::neg_y, 2});
}
