// Tests of the oracle: every possible fault of a mesh is made on purpose, and the oracle must name
// it.
#include "tests/support/mesh/face_oracle.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <utility>

#include "common/mesh/quad.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

using Catch::Matchers::Contains;

/// Groups quads as a mesher would.
QuadLayers layers_of(std::vector<Quad> quads) {
  const auto bin = [](Quad quad) {
    const QuadFields q = unpack(quad);
    const std::array<std::uint8_t, 3> at = {q.x, q.y, q.z};
    return static_cast<std::size_t>(q.direction) * kSideMax +
           at.at(static_cast<std::size_t>(axis_of(q.direction)));
  };
  std::sort(quads.begin(), quads.end(),
            [&](Quad a, Quad b) { return std::pair(bin(a), a) < std::pair(bin(b), b); });
  QuadLayers out;
  out.quads = quads;
  for (std::size_t i = 0; i < out.first.size(); ++i) {
    out.first[i] = static_cast<std::uint32_t>(
        std::count_if(quads.begin(), quads.end(), [&](Quad quad) { return bin(quad) < i; }));
  }
  return out;
}

/// Returns the right mesh of block_scene().
ChunkMesh block_mesh() {
  ChunkMesh mesh;
  mesh.opaque = layers_of({pack({1, 2, 3, 3, 4, Direction::neg_x, kStone}),
                           pack({2, 2, 3, 3, 4, Direction::pos_x, kStone}),
                           pack({1, 2, 3, 4, 2, Direction::neg_y, kStone}),
                           pack({1, 4, 3, 4, 2, Direction::pos_y, kStone}),
                           pack({1, 2, 3, 2, 3, Direction::neg_z, kStone}),
                           pack({1, 2, 6, 2, 3, Direction::pos_z, kStone})});
  std::vector<Quad> water;
  for (unsigned d = 0; d < kDirectionCount; ++d)
    water.push_back(pack({5, 5, 5, 1, 1, static_cast<Direction>(d), kWater}));
  mesh.transparent = layers_of(water);
  return mesh;
}

std::string verdict(const ChunkMesh& mesh) {
  return scene_difference(block_scene(), mesh).value_or("right");
}

TEST_CASE("a mesh written by hand passes the oracle, and so do the same faces in other quads",
          "[mesh]") {
  CHECK(verdict(block_mesh()) == "right");
  ChunkMesh cut = block_mesh();
  auto quads = cut.opaque.quads;
  quads[0] = pack({1, 2, 3, 3, 1, Direction::neg_x, kStone});
  quads.push_back(pack({1, 2, 4, 3, 3, Direction::neg_x, kStone}));
  cut.opaque = layers_of(quads);
  CHECK(verdict(cut) == "right");
}

TEST_CASE("the oracle names what is wrong with a broken mesh", "[mesh]") {
  const auto broken = [](const std::function<void(std::vector<Quad>&)>& change) {
    ChunkMesh mesh = block_mesh();
    auto quads = mesh.opaque.quads;
    change(quads);
    mesh.opaque = layers_of(quads);
    return verdict(mesh);
  };
  CHECK_THAT(broken([](auto& q) { q.pop_back(); }),
             Contains("+z of voxel 1 2 6 in material 1 is missing"));
  CHECK_THAT(broken([](auto& q) { q.push_back(q[0]); }), Contains("covered twice"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 4, 4, Direction::neg_x, kStone}); }),
             Contains("-x of voxel 1 5 3 in material 1 is too many"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 2, 4, Direction::neg_x, kStone}); }),
             Contains("-x of voxel 1 4 3 in material 1 is missing"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 4, 3, Direction::neg_x, kStone}); }),
             !Contains("right"));  // width and height swapped
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 3, 4, Direction::neg_x, kDirt}); }),
             !Contains("right"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 3, 4, Direction::neg_x, kWater}); }),
             Contains("wrong pass"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 3, 3, 4, Direction::neg_x, kBarrier}); }),
             Contains("empty material"));
  CHECK_THAT(broken([](auto& q) { q[0] = pack({1, 2, 5, 3, 4, Direction::neg_x, kStone}); }),
             Contains("leaves the extent"));
  CHECK_THAT(broken([](auto& q) { q[0].bits |= 1ULL << 54; }), Contains("reserved bits"));
  CHECK_THAT(broken([](auto& q) { q[1] = pack({1, 2, 3, 3, 4, Direction::pos_x, kStone}); }),
             !Contains("right"));
}

TEST_CASE("the oracle sees quads in the wrong group", "[mesh]") {
  ChunkMesh mesh = block_mesh();
  std::swap(mesh.opaque.quads[0], mesh.opaque.quads[1]);
  CHECK_THAT(verdict(mesh), Contains("grouped under another direction"));

  mesh = block_mesh();
  --mesh.opaque.first[2];  // moves the quad of layer 1 to layer 2 of -x
  mesh.opaque.first[2] = 0;
  CHECK_THAT(verdict(mesh), Contains("grouped under another layer"));

  mesh = block_mesh();
  mesh.opaque.first.back() -= 1;
  CHECK_THAT(verdict(mesh), Contains("does not span"));

  mesh = block_mesh();
  mesh.opaque.first[5] = 6;
  CHECK_THAT(verdict(mesh), Contains("descends"));

  mesh = block_mesh();
  std::swap(mesh.opaque, mesh.transparent);
  CHECK_THAT(verdict(mesh), Contains("wrong pass"));
}

TEST_CASE("the oracle names what is wrong with a raw list of quads", "[mesh]") {
  const MeshScene scene = block_scene();
  const ChunkMesh mesh = block_mesh();
  std::vector<Quad> right = mesh.transparent.quads;  // in any order, of any pass
  right.insert(right.end(), mesh.opaque.quads.rbegin(), mesh.opaque.quads.rend());
  const auto verdict_of = [&](const std::function<void(std::vector<Quad>&)>& change) {
    std::vector<Quad> quads = right;
    change(quads);
    return quads_difference(quads, scene.chunk.extent, mesh_materials(), expected_faces(scene))
        .value_or("right");
  };
  CHECK(verdict_of([](auto&) {}) == "right");
  CHECK_THAT(verdict_of([](auto& q) { q.pop_back(); }), Contains("is missing"));
  CHECK_THAT(verdict_of([](auto& q) { q.push_back(q[3]); }), Contains("covered twice"));
  CHECK_THAT(
      verdict_of([](auto& q) { q.push_back(pack({0, 0, 0, 1, 1, Direction::pos_y, kStone})); }),
      Contains("is too many"));
  CHECK_THAT(
      verdict_of([](auto& q) { q.push_back(pack({0, 7, 0, 1, 2, Direction::pos_x, kStone})); }),
      !Contains("leaves"));  // v of an x face is z
  CHECK_THAT(
      verdict_of([](auto& q) { q.push_back(pack({0, 7, 0, 2, 1, Direction::pos_x, kStone})); }),
      Contains("leaves the extent"));
  CHECK_THAT(verdict_of([](auto& q) { q[0].bits |= 1ULL << 60; }), Contains("reserved bits"));
  CHECK_THAT(
      verdict_of([](auto& q) { q[0] = pack({5, 5, 5, 1, 1, static_cast<Direction>(6), kWater}); }),
      Contains("looks in no direction"));
  CHECK_THAT(verdict_of([](auto& q) { q[0] = pack({5, 5, 5, 1, 1, Direction::neg_x, kBarrier}); }),
             Contains("empty material"));
}

TEST_CASE("the oracle of a mesher without culling, and of tail culling, by hand", "[mesh]") {
  CHECK(all_faces(DenseChunk::of(block_scene().chunk), mesh_materials()).size() == 25 * 6);
  // Six lines of four stones along z, and one water: all sides except the inner ends.
  CHECK(tail_culled_faces(DenseChunk::of(block_scene().chunk), mesh_materials()).size() ==
        6 * (4 * 4 + 2) + 6);
  // A full chunk is one run: -x only on the first slow layer, -y only on the first line of each.
  const auto faces =
      tail_culled_faces(DenseChunk::of(uniform_chunk(Extent::cube(8), kStone)), mesh_materials());
  const auto count = [&faces](Direction direction) {
    return std::count_if(faces.begin(), faces.end(),
                         [&](const UnitFace& f) { return f.direction == direction; });
  };
  CHECK(count(Direction::pos_x) == 512);
  CHECK(count(Direction::pos_y) == 512);
  CHECK(count(Direction::neg_x) == 64);
  CHECK(count(Direction::neg_y) == 64);
  CHECK(count(Direction::pos_z) == 64);
  CHECK(count(Direction::neg_z) == 64);
}

TEST_CASE("the oracle of runs that hidden faces do not end, by hand", "[mesh]") {
  // Of six stones along y the -x faces of the first and the fourth are hidden by others.
  DenseChunk chunk{Extent::cube(8)};
  for (int y = 1; y <= 6; ++y) chunk.set(3, y, 3, kStone);
  chunk.set(2, 1, 3, kDirt);
  chunk.set(2, 4, 3, kDirt);
  const std::vector<UnitFace> exposed = exposed_faces(chunk, {}, mesh_materials());
  const std::vector<UnitFace> shown = run_on_faces(chunk, exposed);
  const auto shows = [&shown](const UnitFace& face) {
    return std::binary_search(shown.begin(), shown.end(), face);
  };
  CHECK_FALSE(shows({3, 1, 3, Direction::neg_x, kStone}));  // before the first exposed one
  CHECK(shows({3, 4, 3, Direction::neg_x, kStone}));
  CHECK_FALSE(shows({3, 7, 3, Direction::neg_x, kStone}));
  CHECK(shown.size() == exposed.size() + 1);
  CHECK(std::includes(shown.begin(), shown.end(), exposed.begin(), exposed.end()));
}

TEST_CASE("a mesher that ignores a neighbour, a material rule or a border is caught", "[mesh]") {
  // The mesher meshes another scene than the oracle, as a mesher with that mistake would.
  SplitMix64 rng(17);
  int scenes = 0;
  int neighbour = 0;
  int mirrored = 0;
  int visibility = 0;
  MaterialTable all_opaque;
  for (unsigned i = 1; i < kMeshMaterialCount; ++i) {
    MaterialInfo info;
    info.name = "m" + std::to_string(i);
    REQUIRE(all_opaque.add(info).has_value());
  }
  RdmScratch scratch;
  ChunkMesh mesh;
  for (; scenes < 60; ++scenes) {
    const MeshScene scene = random_scene(rng, 12);
    REQUIRE(scene_difference(scene, mesh_of(scene)).value_or("") == "");

    MeshScene forgets = scene;
    for (auto& n : forgets.neighbours) n.reset();
    neighbour += scene_difference(scene, mesh_of(forgets)) ? 1 : 0;

    MeshScene swaps = scene;
    for (std::size_t d = 0; d < kDirectionCount; d += 2)
      std::swap(swaps.neighbours[d], swaps.neighbours[d + 1]);
    mirrored += scene_difference(scene, mesh_of(swaps)) ? 1 : 0;

    mesh_rdm(scene.chunk, scene.pointers(), VisibilityTable(visibilities(all_opaque)), scratch,
             mesh);
    visibility += scene_difference(scene, mesh) ? 1 : 0;
  }
  CHECK(neighbour > scenes / 2);
  CHECK(mirrored > scenes / 2);
  CHECK(visibility > scenes / 2);
}

TEST_CASE("the greedy count merges what a rectangle can cover", "[mesh]") {
  CHECK(greedy_quad_count({}) == 0);
  CHECK(greedy_quad_count(expected_faces(block_scene())) == 12);
  const MeshScene full{uniform_chunk(Extent::cube(8), kStone), {}};
  CHECK(greedy_quad_count(expected_faces(full)) == 6);
}

}  // namespace
}  // namespace runstone::test
