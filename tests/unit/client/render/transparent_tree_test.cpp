#include "client/render/transparent_tree.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/core/hash.hpp"
#include "common/mesh/chunk_mesher.hpp"

using namespace runstone;

namespace {

using Place = std::array<double, 3>;

/// Returns the distance along a ray at which it meets a quad, or a negative number.
double meets(const QuadFields& q, const ShapeTable& shapes, const Place& eye, const Place& ray) {
  const auto axis = static_cast<std::size_t>(axis_of(q.direction));
  const Place corner = {1.0 * q.x, 1.0 * q.y, 1.0 * q.z};
  ShapeFace face;
  face.depth = is_positive(q.direction) ? kShapeUnits : 0;
  if (q.face != 0) face = shapes[q.material].faces.faces()[q.face - 1U];
  const double plane = corner[axis] + face.depth / 16.0;
  const double at = (plane - eye[axis]) / ray[axis];
  const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double pu = eye[u] + at * ray[u] - corner[u], pv = eye[v] + at * ray[v] - corner[v];
  const bool is_in_u = pu > face.u0 / 16.0 && pu < q.width - 1 + face.u1 / 16.0;
  const bool is_in_v = pv > face.v0 / 16.0 && pv < q.height - 1 + face.v1 / 16.0;
  return is_in_u && is_in_v ? at : -1;
}

/// Returns the quads in the order in which they are drawn.
std::vector<QuadFields> drawn_from(const TransparentTree& tree, const Place& eye) {
  std::vector<QuadSpan> spans;
  tree.append_back_to_front(eye, 100, spans);
  std::vector<QuadFields> out;
  for (const QuadSpan& span : spans) {
    for (std::uint32_t i = 0; i < span.count; ++i)
      out.push_back(unpack(tree.pieces()[span.first - 100 + i]));
  }
  return out;
}

/// Returns the number of neighbours along random rays that are drawn in the wrong order.
std::size_t wrong_pairs(const std::vector<QuadFields>& drawn, const Place& eye, SplitMix64& rng,
                        const ShapeTable& shapes = {}) {
  std::size_t wrong = 0;
  for (int step = 0; step < 300; ++step) {
    Place ray{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      ray[axis] = rng.below(16'000) / 1000.0 - eye[axis] + 1e-4;
    std::vector<std::pair<double, std::size_t>> met;
    for (std::size_t q = 0; q < drawn.size(); ++q) {
      const double at = meets(drawn[q], shapes, eye, ray);
      if (at > 0) met.emplace_back(at, q);
    }
    std::sort(met.begin(), met.end());
    for (std::size_t i = 1; i < met.size(); ++i) {
      if (met[i].first - met[i - 1].first < 1e-9) continue;  // in one plane
      wrong += met[i].second > met[i - 1].second ? 1 : 0;
    }
  }
  return wrong;
}

std::vector<Quad> random_quads(SplitMix64& rng, std::size_t count) {
  std::vector<Quad> out;
  while (out.size() < count) {
    const auto at = [&rng] { return static_cast<std::uint8_t>(rng.below(12)); };
    const auto size = [&rng] { return static_cast<std::uint8_t>(1 + rng.below(5)); };
    out.push_back(pack({at(), at(), at(), size(), size(), static_cast<Direction>(rng.below(6)),
                        static_cast<Material>(1 + rng.below(3))}));
  }
  return out;
}

/// Returns how often each unit face, with its direction, material and face, is covered.
std::map<std::array<int, 6>, int> unit_faces(std::span<const Quad> quads) {
  std::map<std::array<int, 6>, int> out;
  for (const Quad& quad : quads) {
    const QuadFields q = unpack(quad);
    const auto u = static_cast<std::size_t>(u_axis_of(axis_of(q.direction)));
    const auto v = static_cast<std::size_t>(v_axis_of(axis_of(q.direction)));
    for (int i = 0; i < q.width; ++i) {
      for (int j = 0; j < q.height; ++j) {
        std::array<int, 6> face = {q.x,        q.y,   q.z, static_cast<int>(q.direction),
                                   q.material, q.face};
        face[u] += i;
        face[v] += j;
        ++out[face];
      }
    }
  }
  return out;
}

constexpr Material kWater = 1, kPane = 2, kCross = 3, kPlant = 4;

/// Water, a pane across x, a pane with arms to four sides, and a plant; all are transparent.
MeshMaterials glass_and_water() {
  std::vector<Visibility> rows(5, Visibility::transparent);
  MeshMaterials out{VisibilityTable(rows)};
  std::vector<Shape> shapes(5);
  shapes[kPane].boxes = {{{7, 0, 0}, {9, 16, 16}}};
  shapes[kCross].boxes = {{{7, 0, 0}, {9, 16, 16}}, {{0, 0, 7}, {16, 16, 9}}};
  shapes[kPlant] = {ShapeForm::crossed, {ShapeBox{{3, 0, 3}, {13, 14, 13}}}};
  for (const Material shaped : {kPane, kCross, kPlant}) rows[shaped] = Visibility::empty;
  out.cubes = VisibilityTable(rows);
  out.shapes = ShapeTable(shapes);
  return out;
}

std::vector<Quad> transparent_quads(const RunChunk& chunk, const MeshMaterials& materials) {
  ChunkMeshScratch scratch;
  ChunkMesh mesh;
  mesh_chunk(chunk, {}, {}, materials, scratch, mesh);
  std::vector<Quad> out = mesh.transparent.quads;
  out.insert(out.end(), mesh.shapes.transparent.begin(), mesh.shapes.transparent.end());
  return out;
}

void put(RunChunk& chunk, LocalPos at, Material material) {
  fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
}

}  // namespace

TEST_CASE("panes and water are drawn from back to front from everywhere", "[render][shapes]") {
  SplitMix64 rng(5);
  const MeshMaterials materials = glass_and_water();
  std::size_t wrong_as_cubes = 0;
  for (int step = 0; step < 30; ++step) {
    RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty);
    for (int i = 0; i < 30; ++i) {
      const auto at = [&rng] { return static_cast<std::uint8_t>(5 + rng.below(4)); };
      const std::array<Material, 4> some = {kWater, kWater, kPane, kCross};
      put(chunk, {at(), at(), at()}, some[rng.below(some.size())]);
    }
    const std::vector<Quad> quads = transparent_quads(chunk, materials);
    const auto tree = TransparentTree::build(quads, materials.shapes);
    REQUIRE(tree.has_value());
    CHECK(unit_faces(tree->pieces()) == unit_faces(quads));
    const auto as_cubes = TransparentTree::build(quads, {});
    REQUIRE(as_cubes.has_value());
    for (int place = 0; place < 4; ++place) {
      const auto at = [&rng] { return rng.below(40'000) / 1000.0 - 12 + 1e-4; };
      const Place eye = {at(), at(), at()};
      CAPTURE(step, place, eye[0], eye[1], eye[2]);
      REQUIRE(wrong_pairs(drawn_from(*tree, eye), eye, rng, materials.shapes) == 0);
      wrong_as_cubes += wrong_pairs(drawn_from(*as_cubes, eye), eye, rng, materials.shapes);
    }
  }
  // The oracle sees the order of a tree that takes faces of shapes for sides of whole voxels.
  CHECK(wrong_as_cubes > 0);
}

TEST_CASE("plants beside water are drawn from the farthest to the nearest, and stay whole",
          "[render][shapes]") {
  const MeshMaterials materials = glass_and_water();
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty);
  put(chunk, {5, 5, 5}, kPlant);
  put(chunk, {6, 5, 5}, kPlant);
  const std::vector<Quad> plants = transparent_quads(chunk, materials);
  CHECK(plants.size() == 8);
  for (std::uint8_t x = 2; x < 10; ++x) put(chunk, {x, 5, 6}, kWater);
  const std::vector<Quad> quads = transparent_quads(chunk, materials);
  for (const std::vector<Quad>& some : {plants, quads}) {
    const auto tree = TransparentTree::build(some, materials.shapes);
    REQUIRE(tree.has_value());
    CHECK(unit_faces(tree->pieces()) == unit_faces(some));
    // The plant that is farther away comes first.
    std::vector<int> plants_drawn;
    for (const QuadFields& quad : drawn_from(*tree, {-3, 5.5, 5.2})) {
      if (quad.material == kPlant) plants_drawn.push_back(quad.x);
    }
    CHECK(plants_drawn == std::vector<int>{6, 6, 6, 6, 5, 5, 5, 5});
  }
}

TEST_CASE("a quad that crosses a plane inside of a voxel is cut around this voxel",
          "[render][shapes]") {
  // Three rods, each of which crosses the plane of the next one. They have no exact order.
  std::vector<Shape> by_material(4);
  by_material[1].boxes = {{{0, 4, 8}, {16, 5, 9}}};
  by_material[2].boxes = {{{8, 0, 4}, {9, 16, 5}}};
  by_material[3].boxes = {{{4, 8, 0}, {5, 9, 16}}};
  const ShapeTable shapes(by_material);
  std::vector<Quad> quads;
  for (const auto& [material, direction] :
       {std::pair{Material{1}, Direction::pos_y}, std::pair{Material{2}, Direction::pos_z},
        std::pair{Material{3}, Direction::pos_x}}) {
    const std::span<const ShapeFace> faces = shapes[material].faces.faces();
    for (std::size_t i = 0; i < faces.size(); ++i) {
      if (faces[i].direction != direction) continue;
      QuadFields quad{4, 4, 4, 1, 1, direction, material};
      quad.face = static_cast<std::uint16_t>(i + 1);
      // Along the rod it goes on to both sides.
      const std::size_t along = material - 1U;
      const bool is_along_u = static_cast<std::size_t>(u_axis_of(axis_of(direction))) == along;
      (is_along_u ? quad.width : quad.height) = 5;
      (along == 0 ? quad.x : along == 1 ? quad.y : quad.z) = 2;
      quads.push_back(pack(quad));
    }
  }
  REQUIRE(quads.size() == 3);
  const auto tree = TransparentTree::build(quads, shapes);
  REQUIRE(tree.has_value());
  CHECK(unit_faces(tree->pieces()) == unit_faces(quads));
  CHECK(tree->pieces().size() > quads.size());
}

TEST_CASE("transparent quads are drawn from back to front from everywhere, also if they cross",
          "[render]") {
  SplitMix64 rng(3);
  for (int step = 0; step < 40; ++step) {
    const std::vector<Quad> quads = random_quads(rng, 40);
    const auto tree = TransparentTree::build(quads, {});
    REQUIRE(tree.has_value());
    CHECK(unit_faces(tree->pieces()) == unit_faces(quads));
    for (int place = 0; place < 4; ++place) {
      const auto at = [&rng] { return rng.below(40'000) / 1000.0 - 12 + 1e-4; };
      const Place eye = {at(), at(), at()};
      std::vector<QuadFields> drawn = drawn_from(*tree, eye);
      REQUIRE(drawn.size() == tree->pieces().size());
      CAPTURE(step, place, eye[0], eye[1], eye[2]);
      REQUIRE(wrong_pairs(drawn, eye, rng) == 0);
      // The oracle is broken on purpose: the opposite order is wrong.
      std::reverse(drawn.begin(), drawn.end());
      REQUIRE(wrong_pairs(drawn, eye, rng) > 0);
    }
  }
}

TEST_CASE("a flat surface is one span, and too many quads have no tree", "[render]") {
  std::vector<Quad> surface;
  for (std::uint8_t x = 0; x < 16; ++x) {
    for (std::uint8_t z = 0; z < 16; ++z)
      surface.push_back(pack({x, 7, z, 1, 1, Direction::pos_y, 2}));
  }
  const auto tree = TransparentTree::build(surface, {});
  REQUIRE(tree.has_value());
  std::vector<QuadSpan> spans;
  tree->append_back_to_front({3, 20, 3}, 0, spans);
  REQUIRE(spans.size() == 1);
  CHECK(spans[0].count == 256);
  CHECK(TransparentTree::build({}, {})->pieces().empty());
  SplitMix64 rng(4);
  CHECK_FALSE(TransparentTree::build(random_quads(rng, TransparentTree::kQuadsMax + 1), {}));
  // Quads that cross each other everywhere are cut into too many pieces.
  CHECK_FALSE(TransparentTree::build(random_quads(rng, TransparentTree::kQuadsMax), {}));
}
