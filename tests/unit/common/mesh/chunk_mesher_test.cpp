#include "common/mesh/chunk_mesher.hpp"

#include <catch2/catch.hpp>

#include "common/runs/layer_diff.hpp"

namespace runstone::test {
namespace {

constexpr Material kStoneCube = 1, kLowSlab = 2;

MeshMaterials stone_and_slabs() {
  MeshMaterials out{VisibilityTable(
      std::vector<Visibility>{Visibility::empty, Visibility::opaque, Visibility::opaque})};
  out.cubes = VisibilityTable(
      std::vector<Visibility>{Visibility::empty, Visibility::opaque, Visibility::empty});
  out.shapes = ShapeTable(
      std::vector<Shape>{{}, {}, {ShapeForm::boxes, {ShapeBox{{0, 0, 0}, {16, 8, 16}}}}});
  return out;
}

void put(RunChunk& chunk, LocalPos at, Material material) {
  fill(chunk, index_of(at, chunk.extent, chunk.order), 1, material);
}

void check_equal(const ChunkMesh& a, const ChunkMesh& b) {
  CHECK(a.opaque.quads == b.opaque.quads);
  CHECK(a.transparent.quads == b.transparent.quads);
  CHECK(a.shapes.opaque == b.shapes.opaque);
  CHECK(a.shapes.transparent == b.shapes.transparent);
}

TEST_CASE("an edit beside a shape meshes it again, in the chunk and beyond its border",
          "[mesh][shapes]") {
  const MeshMaterials materials = stone_and_slabs();
  for (const AxisOrder order : kAxisOrders) {
    CAPTURE(order);
    ChunkMeshScratch scratch;
    RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty, order);
    RunChunk below = chunk;
    put(chunk, {4, 0, 4}, kLowSlab);
    put(chunk, {9, 9, 9}, kStoneCube);
    MeshNeighbours neighbours{};
    neighbours[static_cast<std::size_t>(Direction::neg_y)] = &below;
    ChunkMesh mesh;
    mesh_chunk(chunk, neighbours, {}, materials, scratch, mesh);
    CHECK(mesh.opaque.quads.size() == 6);
    CHECK(mesh.shapes.opaque.size() == 6);

    // Stone beside the slab hides the side that it covers, and keeps its own six faces.
    const RunChunk before = chunk;
    put(chunk, {5, 0, 4}, kStoneCube);
    mesh_chunk_layers(chunk, neighbours, {}, materials, changed_layers(before, chunk), {}, scratch,
                      mesh);
    CHECK(mesh.opaque.quads.size() == 12);
    CHECK(mesh.shapes.opaque.size() == 5);

    // Stone below, in the neighbour, hides the lower face, although no cube of the chunk changes.
    const RunChunk below_before = below;
    put(below, {4, 15, 4}, kStoneCube);
    std::array<DirtyLayers, kDirectionCount> beyond{};
    beyond[static_cast<std::size_t>(Direction::neg_y)] = changed_layers(below_before, below);
    mesh_chunk_layers(chunk, neighbours, {}, materials, {}, beyond, scratch, mesh);
    CHECK(mesh.shapes.opaque.size() == 4);
    ChunkMesh whole;
    mesh_chunk(chunk, neighbours, {}, materials, scratch, whole);
    check_equal(mesh, whole);

    put(chunk, {4, 0, 4}, kEmpty);
    mesh_chunk(chunk, neighbours, {}, materials, scratch, mesh);
    CHECK(mesh.shapes.opaque.empty());
  }
}

TEST_CASE("a mesh of cubes has no quads of shapes, as materials or as a chunk", "[mesh][shapes]") {
  ChunkMeshScratch scratch;
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty);
  put(chunk, {4, 0, 4}, kLowSlab);
  ChunkMesh mesh;
  mesh.shapes.opaque = {Quad{1}};
  const MeshMaterials cubes{VisibilityTable({})};
  mesh_chunk(chunk, {}, {}, cubes, scratch, mesh);
  CHECK(mesh.opaque.quads.size() == 6);
  CHECK(mesh.shapes.opaque.empty());
  put(chunk, {4, 0, 4}, kStoneCube);
  mesh_chunk(chunk, {}, {}, stone_and_slabs(), scratch, mesh);
  CHECK(mesh.opaque.quads.size() == 6);
  CHECK(mesh.shapes.opaque.empty());
}

}  // namespace
}  // namespace runstone::test
