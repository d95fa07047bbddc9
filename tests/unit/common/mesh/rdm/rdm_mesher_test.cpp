#include "common/mesh/rdm/rdm_mesher.hpp"

#include <catch2/catch.hpp>

#include "common/mesh/quad_corners.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/mesh/mesh_scene.hpp"

namespace runstone::test {
namespace {

constexpr Extent kSmall = Extent::cube(8);

/// Makes a chunk with material(x, y, z) for every voxel.
template <class F>
RunChunk chunk_where(Extent extent, AxisOrder order, F&& material) {
  RunBuilder builder(extent, order);
  for (std::uint32_t i = 0; i < extent.volume(); ++i) {
    const LocalPos p = pos_of(i, extent, order);
    builder.append(1, material(int{p.x}, int{p.y}, int{p.z}));
  }
  return builder.finish();
}

MeshScene scene_of(RunChunk chunk) { return {std::move(chunk), {}}; }

MeshScene surrounded(RunChunk chunk, Material by) {
  MeshScene scene = scene_of(std::move(chunk));
  for (auto& neighbour : scene.neighbours) neighbour = uniform_chunk(scene.chunk.extent, by);
  return scene;
}

/// Meshes the scene and checks the mesh with the oracle.
ChunkMesh checked_mesh(const MeshScene& scene) {
  ChunkMesh mesh = mesh_of(scene);
  REQUIRE(scene_difference(scene, mesh).value_or("") == "");
  return mesh;
}

/// The thesis' sphere: distance of the voxel's corner from the middle of a chunk of edge 32.
bool in_sphere(int x, int y, int z, int radius) {
  return (x - 16) * (x - 16) + (y - 16) * (y - 16) + (z - 16) * (z - 16) < radius * radius;
}

std::size_t faces_of(const ChunkMesh& mesh, Material material) {
  std::size_t count = 0;
  for (const UnitFace& face : unit_faces(mesh)) count += face.material == material ? 1 : 0;
  return count;
}

TEST_CASE("an empty chunk has no mesh", "[mesh]") {
  CHECK(checked_mesh(surrounded(uniform_chunk(kSmall, kEmpty), kStone)).empty());
  CHECK(checked_mesh(surrounded(uniform_chunk(kSmall, kBarrier), kStone)).empty());
}

TEST_CASE("a single voxel has six quads, one per direction, in its layers", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    RunChunk chunk = uniform_chunk(kSmall, kEmpty, order);
    fill(chunk, index_of({3, 4, 5}, kSmall, order), 1, kDirt);
    const ChunkMesh mesh = checked_mesh(scene_of(chunk));
    REQUIRE(mesh.opaque.quads.size() == 6);
    CHECK(mesh.transparent.quads.empty());
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto direction = static_cast<Direction>(d);
      const auto quads = mesh.opaque.layer(direction, std::array<unsigned, 3>{3, 4, 5}.at(d / 2));
      REQUIRE(quads.size() == 1);
      CHECK(unpack(quads[0]) == QuadFields{3, 4, 5, 1, 1, direction, kDirt});
    }
  }
}

TEST_CASE("the quads of a small scene have these bits", "[mesh]") {
  // Golden bits: quad packing, grouping and order, for the renderer that reads the bytes.
  RunChunk chunk = uniform_chunk(kSmall, kEmpty, AxisOrder::xyz);
  fill(chunk, index_of({1, 2, 3}, kSmall, AxisOrder::xyz), 2, kStone);
  fill(chunk, index_of({3, 2, 3}, kSmall, AxisOrder::xyz), 1, kWater);
  const ChunkMesh mesh = checked_mesh(scene_of(chunk));
  const std::vector<Quad> opaque = {{0x40'0000'c101ULL}, {0x48'0000'c102ULL}, {0x50'1000'c101ULL},
                                    {0x58'1000'c101ULL}, {0x60'0020'c101ULL}, {0x68'0020'c101ULL}};
  const std::vector<Quad> transparent = {{0xc8'0000'c103ULL},
                                         {0xd0'0000'c103ULL},
                                         {0xd8'0000'c103ULL},
                                         {0xe0'0000'c103ULL},
                                         {0xe8'0000'c103ULL}};
  CHECK(mesh.opaque.quads == opaque);
  CHECK(mesh.transparent.quads == transparent);
}

TEST_CASE("a full chunk alone has six quads, and none between full neighbours", "[mesh]") {
  for (const Extent extent : {kSmall, Extent{8, 20, 128}, Extent::cube(32)}) {
    for (const AxisOrder order : kAxisOrders) {
      const RunChunk chunk = uniform_chunk(extent, kStone, order);
      const ChunkMesh alone = checked_mesh(scene_of(chunk));
      REQUIRE(alone.opaque.quads.size() == 6);
      for (const Quad quad : alone.opaque.quads) {
        const QuadFields q = unpack(quad);
        const auto u = static_cast<std::size_t>(u_axis_of(axis_of(q.direction)));
        const auto v = static_cast<std::size_t>(v_axis_of(axis_of(q.direction)));
        CHECK(q.width == extent.sides()[u]);
        CHECK(q.height == extent.sides()[v]);
      }
      CHECK(checked_mesh(surrounded(chunk, kStone)).empty());
      CHECK(checked_mesh(surrounded(chunk, kDirt)).empty());
      CHECK(checked_mesh(surrounded(chunk, kWater)).opaque.quads.size() == 6);
    }
  }
}

TEST_CASE("each direction is culled by its own neighbour", "[mesh]") {
  for (unsigned d = 0; d < kDirectionCount; ++d) {
    MeshScene scene = scene_of(uniform_chunk(kSmall, kStone));
    scene.neighbours[d] = uniform_chunk(kSmall, kDirt);
    const ChunkMesh mesh = checked_mesh(scene);
    REQUIRE(mesh.opaque.quads.size() == 5);
    for (const Quad quad : mesh.opaque.quads)
      CHECK(unpack(quad).direction != static_cast<Direction>(d));
  }
}

TEST_CASE("borders are culled for all pairs of axis orders in all directions", "[mesh]") {
  const Extent extent{8, 9, 10};
  const auto pattern = [](int salt) {
    return [salt](int x, int y, int z) {
      return static_cast<Material>(
          mix64(static_cast<std::uint64_t>(((salt * 31 + x) * 31 + y) * 31 + z)) % 4);
    };
  };
  for (const AxisOrder ours : kAxisOrders) {
    for (const AxisOrder theirs : kAxisOrders) {
      const RunChunk chunk = chunk_where(extent, ours, pattern(1));
      const RunChunk other = chunk_where(extent, theirs, pattern(2));
      for (unsigned d = 0; d < kDirectionCount; ++d) {
        MeshScene scene = scene_of(chunk);
        scene.neighbours[d] = other;
        CAPTURE(ours, theirs, d);
        checked_mesh(scene);
      }
    }
  }
}

TEST_CASE("a neighbour may be deeper than the chunk", "[mesh]") {
  MeshScene scene = scene_of(uniform_chunk(kSmall, kStone));
  scene.neighbours[static_cast<std::size_t>(Direction::neg_y)] = chunk_where(
      {8, 20, 8}, AxisOrder::yzx, [](int, int y, int) { return y == 19 ? kDirt : kEmpty; });
  CHECK(checked_mesh(scene).opaque.quads.size() == 5);
}

TEST_CASE("two opaque materials hide each other and never share a quad", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    const ChunkMesh mesh = checked_mesh(scene_of(
        chunk_where(kSmall, order, [](int, int y, int) { return y < 4 ? kStone : kDirt; })));
    // The quads are the top, the bottom, and two materials on each of the four sides.
    CHECK(mesh.opaque.quads.size() == 10);
    CHECK(faces_of(mesh, kStone) == 64 + 4 * 32);
    CHECK(faces_of(mesh, kDirt) == 64 + 4 * 32);
  }
}

TEST_CASE("water next to water shows nothing between them, also across a border", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    const RunChunk half =
        chunk_where(kSmall, order, [](int x, int, int) { return x < 4 ? kWater : kEmpty; });
    const ChunkMesh mesh = checked_mesh(scene_of(half));
    CHECK(mesh.opaque.quads.empty());
    CHECK(mesh.transparent.quads.size() == 6);
    CHECK(checked_mesh(surrounded(uniform_chunk(kSmall, kWater, order), kWater)).empty());
  }
}

TEST_CASE("water against glass shows both faces, in the transparent pass", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    const ChunkMesh mesh = checked_mesh(surrounded(
        chunk_where(kSmall, order, [](int x, int, int) { return x < 4 ? kWater : kGlass; }),
        kStone));
    CHECK(mesh.opaque.quads.empty());
    REQUIRE(mesh.transparent.quads.size() == 2);
    CHECK(unpack(mesh.transparent.layer(Direction::pos_x, 3)[0]).material == kWater);
    CHECK(unpack(mesh.transparent.layer(Direction::neg_x, 4)[0]).material == kGlass);
  }
}

TEST_CASE("water against stone shows the stone and not the water", "[mesh]") {
  for (const AxisOrder order : kAxisOrders) {
    const ChunkMesh mesh = checked_mesh(surrounded(
        chunk_where(kSmall, order, [](int, int y, int) { return y < 4 ? kStone : kWater; }),
        kStone));
    CHECK(mesh.transparent.quads.empty());
    REQUIRE(mesh.opaque.quads.size() == 1);
    CHECK(unpack(mesh.opaque.quads[0]) == QuadFields{0, 3, 0, 8, 8, Direction::pos_y, kStone});
  }
}

TEST_CASE("a strip continues where only the voxels that it faces change", "[mesh]") {
  // A wall of stone towards water below and air above is one quad in every axis order.
  for (const AxisOrder order : kAxisOrders) {
    const ChunkMesh mesh = checked_mesh(surrounded(
        chunk_where(kSmall, order,
                    [](int x, int y, int) { return x < 4   ? kStone
                                                   : y < 4 ? kWater
                                                           : kEmpty; }),
        kStone));
    CHECK(mesh.opaque.layer(Direction::pos_x, 3).size() == 1);
  }
}

TEST_CASE("faces at the end of a line are not faces to the start of the next", "[mesh]") {
  // One voxel at the end of a line and one at the start of the next are adjacent in index order,
  // but not in space.
  for (const AxisOrder order : kAxisOrders) {
    RunChunk chunk = uniform_chunk(kSmall, kEmpty, order);
    fill(chunk, 8 * 11 - 1, 2, kStone);
    CHECK(unit_faces(checked_mesh(scene_of(chunk))).size() == 12);
    RunChunk layers = uniform_chunk(kSmall, kEmpty, order);
    fill(layers, 64 * 3 - 1, 2, kStone);
    CHECK(unit_faces(checked_mesh(scene_of(layers))).size() == 12);
  }
}

TEST_CASE("shapes of the thesis have its face and vertex counts", "[mesh]") {
  // Scenarios 1-4, 6-8, 9, 17, 23, 28 and 33 of the thesis for a chunk alone. Its (x, y, z) is (x,
  // z, y) here and its index order is zyx. A quad has four vertices; merged counts are those of its
  // grid mesher.
  struct Case {
    const char* name;
    bool (*solid)(int x, int y, int z);  // in the thesis' axes
    std::size_t vertices_culled, vertices_merged;
  };
  const Case cases[] = {
      {"Full", [](int, int, int) { return true; }, 24576, 24},
      {"HalfX", [](int x, int, int) { return x < 16; }, 16384, 24},
      {"HalfZ", [](int, int, int z) { return z < 16; }, 16384, 24},
      {"HalfY", [](int, int y, int) { return y < 16; }, 16384, 24},
      {"SphereSmall", [](int x, int y, int z) { return in_sphere(x, y, z, 4); }, 1080, 456},
      {"SphereMid", [](int x, int y, int z) { return in_sphere(x, y, z, 8); }, 4632, 1944},
      {"SphereLarge", [](int x, int y, int z) { return in_sphere(x, y, z, 16); }, 19032, 8520},
      {"StripsComplex",
       [](int x, int y, int z) { return x / 11 % 2 == 0 && y / 11 % 2 == 0 && z / 11 % 2 == 0; },
       21168, 192},
      {"Chessboard", [](int x, int y, int z) { return (x + y + z) % 2 == 0; }, 393216, 393216},
      {"StripsY", [](int, int y, int) { return y % 2 == 0; }, 139264, 384},
      {"StripsZ1", [](int, int, int z) { return z % 2 == 0; }, 139264, 384},
      {"StripsX1", [](int x, int, int) { return x % 2 == 0; }, 139264, 384},
  };
  for (const Case& c : cases) {
    for (const AxisOrder order : kAxisOrders) {
      const MeshScene scene =
          scene_of(chunk_where(Extent::cube(32), order, [&](int x, int y, int z) {
            return c.solid(x, z, y) ? kStone : kEmpty;
          }));
      const ChunkMesh mesh = mesh_of(scene);
      CAPTURE(c.name, order);
      CHECK(4 * expected_faces(scene).size() == c.vertices_culled);
      CHECK(4 * unit_faces(mesh).size() == c.vertices_culled);
      CHECK(4 * mesh.quad_count() == c.vertices_merged);
      if (order == AxisOrder::zyx) CHECK(scene_difference(scene, mesh).value_or("") == "");
    }
  }
}

TEST_CASE("every quad of a mesh winds towards its direction", "[mesh]") {
  SplitMix64 rng(7);
  for (int round = 0; round < 20; ++round) {
    const ChunkMesh mesh = mesh_of(random_scene(rng, 12));
    for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
      for (const Quad quad : pass->quads) {
        const auto c = quad_corners(quad);
        const Direction direction = unpack(quad).direction;
        const auto axis = static_cast<std::size_t>(axis_of(direction));
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        const int area =
            (c[1][u] - c[0][u]) * (c[2][v] - c[1][v]) - (c[1][v] - c[0][v]) * (c[2][u] - c[1][u]);
        REQUIRE((area > 0) == is_positive(direction));
        REQUIRE(std::abs(area) == unpack(quad).width * unpack(quad).height);
      }
    }
  }
}

TEST_CASE("a mesh replaces what was in the output", "[mesh]") {
  RdmScratch scratch;
  ChunkMesh mesh;
  const RunChunk water = uniform_chunk(kSmall, kWater);
  const RunChunk stone = uniform_chunk(kSmall, kStone);
  mesh_rdm(water, {}, mesh_visibility(), scratch, mesh);
  CHECK(mesh.transparent.quads.size() == 6);
  mesh_rdm(stone, {}, mesh_visibility(), scratch, mesh);
  CHECK(mesh.transparent.quads.empty());
  CHECK(mesh.opaque.quads.size() == 6);
  mesh_rdm(uniform_chunk(kSmall, kEmpty), {}, mesh_visibility(), scratch, mesh);
  CHECK(mesh.empty());
  CHECK(mesh.opaque.first == QuadLayers{}.first);
}

TEST_CASE("scratch can be moved with its buffers", "[mesh]") {
  RdmScratch first;
  RdmScratch second = std::move(first);
  ChunkMesh mesh;
  mesh_rdm(uniform_chunk(kSmall, kStone), {}, mesh_visibility(), second, mesh);
  CHECK(mesh.quad_count() == 6);
}

}  // namespace
}  // namespace runstone::test
