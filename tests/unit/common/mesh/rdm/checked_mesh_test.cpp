#include "common/mesh/rdm/checked_mesh.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a neighbour of another size, or a chunk that is not valid, is not meshed", "[mesh]") {
  const auto table = visibility_table(std::vector{Visibility::empty, Visibility::opaque});
  REQUIRE(table.has_value());
  const RunChunk chunk = uniform_chunk(Extent{16, 32, 16}, 1);
  RdmScratch scratch;
  ChunkMesh mesh;
  REQUIRE(try_mesh_rdm(chunk, {}, *table, scratch, mesh).has_value());
  CHECK(mesh.quad_count() == 6);

  const RunChunk higher = uniform_chunk(Extent{16, 64, 16}, 1);
  MeshNeighbours neighbours{};
  neighbours[static_cast<std::size_t>(Direction::pos_y)] = &higher;  // only its face counts
  REQUIRE(try_mesh_rdm(chunk, neighbours, *table, scratch, mesh).has_value());
  CHECK(mesh.quad_count() == 5);
  neighbours[static_cast<std::size_t>(Direction::neg_x)] = &higher;
  const auto meshed = try_mesh_rdm(chunk, neighbours, *table, scratch, mesh);
  REQUIRE_FALSE(meshed.has_value());
  CHECK(meshed.error().offset == static_cast<std::uint64_t>(Direction::neg_x));
  CHECK(mesh.quad_count() == 5);

  const RunChunk small = uniform_chunk(Extent::cube(4), 1);
  CHECK_FALSE(try_mesh_rdm(small, {}, *table, scratch, mesh).has_value());
  neighbours = {};
  RunChunk broken = chunk;
  broken.runs.clear();
  CHECK_FALSE(try_mesh_rdm(broken, {}, *table, scratch, mesh).has_value());
  neighbours[0] = &broken;
  CHECK_FALSE(try_mesh_rdm(chunk, neighbours, *table, scratch, mesh).has_value());
}

TEST_CASE("a table of more visibilities than materials is refused", "[mesh]") {
  CHECK(visibility_table(std::vector<Visibility>(kMaterialCountMax)).has_value());
  CHECK_FALSE(visibility_table(std::vector<Visibility>(kMaterialCountMax + 1)).has_value());
}
