// Tests of the triangle oracle, like face_oracle_test: every possible fault of a mesh of triangles
// is made on purpose. Then the oracle is compared with a second method: counting the triangles over
// many points.
#include "tests/support/mesh/triangle_oracle.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <map>

#include "common/mesh/quad_corners.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;
using reference::MeshTriangle;
using reference::MeshVertex;
using reference::TriangleMesh;

MeshVertex vertex_at(const Corner& corner) {
  return {static_cast<std::uint8_t>(corner[0]), static_cast<std::uint8_t>(corner[1]),
          static_cast<std::uint8_t>(corner[2])};
}

/// Returns each quad as two triangles with vertices of their own.
TriangleMesh triangles_of(const std::vector<Quad>& quads) {
  TriangleMesh out;
  for (const Quad quad : quads) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    for (const Corner& corner : quad_corners(quad)) out.vertices.push_back(vertex_at(corner));
    const QuadFields q = unpack(quad);
    out.triangles.push_back({{first, first + 1, first + 2}, q.direction, q.material});
    out.triangles.push_back({{first, first + 2, first + 3}, q.direction, q.material});
  }
  return out;
}

TriangleMesh box_mesh() {
  const ChunkMesh mesh = mesh_of(block_scene());
  std::vector<Quad> quads = mesh.opaque.quads;
  quads.insert(quads.end(), mesh.transparent.quads.begin(), mesh.transparent.quads.end());
  return triangles_of(quads);
}

std::string verdict(const TriangleMesh& mesh) {
  return triangles_difference(mesh, Extent::cube(8), mesh_materials(),
                              expected_faces(block_scene()))
      .value_or("right");
}

TEST_CASE(
    "quads cut into triangles pass the triangle oracle, and so do other triangles of the same "
    "faces",
    "[mesh]") {
  TriangleMesh mesh = box_mesh();
  CHECK(mesh.triangles.size() == 24);
  CHECK(verdict(mesh) == "right");
  std::reverse(mesh.triangles.begin(), mesh.triangles.end());
  CHECK(verdict(mesh) == "right");

  // The side -x of the stone, 3 x 4, as a fan around a point that is no corner.
  TriangleMesh fan = box_mesh();
  const auto side = [](const MeshTriangle& t) {
    return t.direction == Direction::neg_x && t.material == kStone;
  };
  const auto at = std::find_if(fan.triangles.begin(), fan.triangles.end(), side);
  REQUIRE(at != fan.triangles.end());
  const std::uint32_t first = at->vertices[0];
  fan.triangles.erase(at, at + 2);
  fan.vertices.push_back({1, 3, 4});
  const auto middle = static_cast<std::uint32_t>(fan.vertices.size() - 1);
  for (std::uint32_t i = 0; i < 4; ++i) {
    fan.triangles.push_back({{first + i, first + (i + 1) % 4, middle}, Direction::neg_x, kStone});
  }
  CHECK(verdict(fan) == "right");
  fan.vertices.back() = {1, 2, 4};  // on the edge: one triangle has no area
  CHECK_THAT(verdict(fan), Contains("has no area"));
}

TEST_CASE("the triangle oracle names what is wrong with a broken mesh", "[mesh]") {
  const auto broken = [](const std::function<void(TriangleMesh&)>& change) {
    TriangleMesh mesh = box_mesh();
    change(mesh);
    return verdict(mesh);
  };
  const std::string odd = "what is covered ends where no face does";
  // Both triangles of a quad use its corners 0 and 2.
  CHECK_THAT(broken([](auto& m) {
               m.triangles.erase(m.triangles.begin()), m.vertices.erase(m.vertices.begin() + 1);
               for (auto& t : m.triangles)
                 for (auto& v : t.vertices) v -= v > 0 ? 1 : 0;
             }),
             Contains(odd));
  CHECK_THAT(broken([](auto& m) { m.triangles.push_back(m.triangles[3]); }), Contains(odd));
  // The same area, but one half is covered twice and one not at all.
  CHECK_THAT(broken([](auto& m) {
               m.triangles[0].vertices = {0, 1, 2};
               m.triangles[1].vertices = {0, 1, 3};
             }),
             Contains(odd));
  CHECK_THAT(
      broken([](auto& m) { std::swap(m.triangles[5].vertices[0], m.triangles[5].vertices[1]); }),
      Contains("triangle 5 winds the wrong way"));
  // A flipped triangle would cancel a doubled one.
  CHECK_THAT(broken([](auto& m) {
               MeshTriangle twin = m.triangles[0];
               m.triangles.push_back(twin);
               std::swap(twin.vertices[0], twin.vertices[1]);
               m.triangles.push_back(twin);
             }),
             Contains("winds the wrong way"));
  CHECK_THAT(broken([](auto& m) { m.triangles[0].material = m.triangles[1].material = kDirt; }),
             Contains(odd));
  CHECK_THAT(broken([](auto& m) { m.triangles[0].material = kBarrier; }),
             Contains("empty material"));
  CHECK_THAT(broken([](auto& m) { m.triangles[0].material = kDirt; }), Contains("shares a vertex"));
  CHECK_THAT(broken([](auto& m) { m.triangles[0].direction = static_cast<Direction>(6); }),
             Contains("looks in no direction"));
  CHECK_THAT(broken([](auto& m) { m.triangles[0].vertices[2] = 10000; }),
             Contains("does not exist"));
  CHECK_THAT(broken([](auto& m) { m.vertices[0].y = 9; }), Contains("leaves the extent"));
  CHECK_THAT(broken([](auto& m) { m.vertices.push_back({}); }), Contains("is not used"));
  CHECK_THAT(broken([](auto& m) {
               const auto axis = static_cast<unsigned>(m.triangles[0].direction) / 2;
               auto& vertex = m.vertices[m.triangles[0].vertices[0]];
               (axis == 0 ? vertex.x : axis == 1 ? vertex.y : vertex.z) += 1;
             }),
             Contains("lies across planes"));
  // A whole quad moves to the next plane.
  CHECK_THAT(broken([](auto& m) {
               const auto axis = static_cast<unsigned>(m.triangles[0].direction) / 2;
               for (std::size_t i = 0; i < 4; ++i)
                 (axis == 0 ? m.vertices[i].x : axis == 1 ? m.vertices[i].y : m.vertices[i].z) += 1;
             }),
             Contains(odd));
}

TEST_CASE("a surface is checked by its kind, quads or triangles", "[mesh]") {
  reference::Surface surface;
  const auto judge = [&surface] {
    return surface_difference(surface, Extent::cube(8), mesh_materials(),
                              expected_faces(block_scene()))
        .value_or("right");
  };
  CHECK_THAT(judge(), Contains("is missing"));
  surface.triangles = box_mesh();
  CHECK(judge() == "right");
  CHECK(surface.vertex_count() == 48);
  CHECK(surface.triangle_count() == 24);
  surface.quads = mesh_of(block_scene()).opaque.quads;
  CHECK_THAT(judge(), Contains("quads and triangles"));
  surface.triangles.clear();
  CHECK_THAT(judge(), Contains("is missing"));  // the water
}

/// The +z faces of a layer of 6 x 6, some of them present, each cut along either diagonal.
struct Patch {
  std::vector<UnitFace> faces;
  TriangleMesh mesh;
};

Patch random_patch(SplitMix64& rng) {
  Patch out;
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x) {
      if (rng.below(3) == 0) continue;
      out.faces.push_back({x, y, 2, Direction::pos_z, kStone});
      const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
      for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
        out.mesh.vertices.push_back(vertex_at({x + u, y + v, 3}));
      const std::uint32_t turn = rng.below(2);
      for (const std::uint32_t i : {0u, 2u}) {
        out.mesh.triangles.push_back(
            {{first + (turn + i) % 4, first + (turn + i + 1) % 4, first + (turn + i + 2) % 4},
             Direction::pos_z,
             kStone});
      }
    }
  }
  std::sort(out.faces.begin(), out.faces.end());
  return out;
}

/// Moves a corner of some triangle, doubles or removes one, or does nothing. The covered faces may
/// stay the same.
void disturb(TriangleMesh& mesh, SplitMix64& rng) {
  if (mesh.triangles.empty()) return;
  const std::uint32_t i = rng.below(static_cast<std::uint32_t>(mesh.triangles.size()));
  MeshTriangle& triangle = mesh.triangles[i];
  switch (rng.below(4)) {
    case 0:
      mesh.triangles.push_back(triangle);
      break;
    case 1: {
      mesh.vertices.push_back(
          {static_cast<std::uint8_t>(rng.below(7)), static_cast<std::uint8_t>(rng.below(7)), 3});
      triangle.vertices[rng.below(3)] = static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      break;
    }
    case 2: {  // moves a vertex of all its triangles by one
      MeshVertex& vertex = mesh.vertices[triangle.vertices[0]];
      vertex.x = static_cast<std::uint8_t>(vertex.x == 6 ? 5 : vertex.x + 1);
      break;
    }
    default:
      break;
  }
}

/// Returns true if the triangles cover the faces and nothing else, and none winds the wrong way. It
/// tests points spread over the layer, 13 x 13 in each unit face, none on an edge between lattice
/// points this close. Each must lie in one triangle where there is a face and in none elsewhere.
bool covers_points(const Patch& patch) {
  constexpr int kScale = 13 * 97;
  std::map<std::pair<int, int>, int> cover;
  for (const MeshTriangle& triangle : patch.mesh.triangles) {
    std::array<std::array<int, 2>, 3> p;
    for (std::size_t c = 0; c < 3; ++c) {
      const MeshVertex& vertex = patch.mesh.vertices[triangle.vertices[c]];
      p[c] = {vertex.x * kScale, vertex.y * kScale};
    }
    const auto left_of = [&](std::size_t c, int x, int y) {
      const auto& a = p[c];
      const auto& b = p[(c + 1) % 3];
      return std::int64_t{b[0] - a[0]} * (y - a[1]) > std::int64_t{b[1] - a[1]} * (x - a[0]);
    };
    if (!left_of(0, p[2][0], p[2][1])) return false;
    for (int y = 41; y < 6 * kScale; y += 97) {
      for (int x = 19; x < 6 * kScale; x += 97) {
        if (left_of(0, x, y) && left_of(1, x, y) && left_of(2, x, y))
          ++cover[{x / kScale * 100 + y / kScale, x * 10000 + y}];
      }
    }
  }
  std::size_t points = 0;
  for (const auto& [at, times] : cover) {
    const UnitFace face{at.first / 100, at.first % 100, 2, Direction::pos_z, kStone};
    if (times != 1 || !std::binary_search(patch.faces.begin(), patch.faces.end(), face))
      return false;
    ++points;
  }
  return points == patch.faces.size() * 13 * 13;
}

TEST_CASE("the triangle oracle agrees with counting triangles over points", "[mesh]") {
  SplitMix64 rng(31);
  int right = 0;
  int wrong = 0;
  for (int round = 0; round < 600; ++round) {
    Patch patch = random_patch(rng);
    disturb(patch.mesh, rng);
    // Unused vertices do not matter for covering.
    TriangleMesh compact;
    for (MeshTriangle triangle : patch.mesh.triangles) {
      for (auto& vertex : triangle.vertices) {
        compact.vertices.push_back(patch.mesh.vertices[vertex]);
        vertex = static_cast<std::uint32_t>(compact.vertices.size() - 1);
      }
      compact.triangles.push_back(triangle);
    }
    const auto fault =
        triangles_difference(compact, Extent::cube(8), mesh_materials(), patch.faces);
    CAPTURE(round, fault.value_or("right"));
    REQUIRE(!fault == covers_points(patch));
    (fault ? wrong : right) += 1;
  }
  CHECK(right > 100);
  CHECK(wrong > 200);
}

}  // namespace
}  // namespace runstone::test
