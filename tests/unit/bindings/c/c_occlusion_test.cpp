#include <array>
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/mesh/occlusion/quad_occlusion.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

const std::vector<std::uint8_t> kKindsOfRows = {RUNSTONE_EMPTY, RUNSTONE_OPAQUE,
                                                RUNSTONE_TRANSPARENT, RUNSTONE_OPAQUE};

std::vector<std::uint64_t> packed_quads(const runstone_mesh* mesh) {
  return fetched<std::uint64_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, out, room, n);
  });
}
std::vector<std::uint8_t> corner_bytes(const runstone_mesh* mesh) {
  return fetched<std::uint8_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_occlusion(mesh, RUNSTONE_PASS_OPAQUE, out, room, n);
  });
}
std::vector<runstone_vertex> cube_vertices(const runstone_mesh* mesh) {
  return fetched<runstone_vertex>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_vertices(mesh, RUNSTONE_PASS_OPAQUE, out, room, n);
  });
}

}  // namespace

TEST_CASE("occlusion of the C interface is that of the library", "[c_interface]") {
  SplitMix64 rng{81};
  const auto visibility = visibility_handle(kKindsOfRows);
  const VisibilityTable table(std::array{Visibility::empty, Visibility::opaque,
                                         Visibility::transparent, Visibility::opaque});
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  RdmScratch scratch;
  OpaqueBits bits;
  OccludedQuads expected;
  for (int round = 0; round < 12; ++round) {
    CAPTURE(round);
    std::array<RunChunk, 27> chunks;
    std::array<Owned<runstone_chunk>, 27> handles;
    ChunksAround around{};
    std::array<const runstone_chunk*, 27> pointers{};
    for (std::size_t i = 0; i < 27; ++i) {
      if (i != 13 && rng.below(4) == 0) continue;
      chunks[i] = random_chunk(rng, Extent::cube(12), random_order(rng), 4);
      handles[i] = handle_of(chunks[i]);
      if (i == 13) continue;
      around[i] = &chunks[i];
      pointers[i] = handles[i].get();
    }
    constexpr std::array<std::size_t, 6> kBeside = {12, 14, 10, 16, 4, 22};
    MeshNeighbours neighbours{};
    std::array<const runstone_chunk*, 6> beside{};
    for (std::size_t d = 0; d < 6; ++d) {
      neighbours[d] = around[kBeside[d]];
      beside[d] = pointers[kBeside[d]];
    }
    ChunkMesh plain;
    mesh_rdm(chunks[13], neighbours, table, scratch, plain);
    bits.read(chunks[13], around, table);
    occlude_quads(plain.opaque, bits, expected);

    REQUIRE(runstone_mesh_chunk(mesh.get(), handles[13].get(), beside.data(), nullptr,
                                visibility.get()) == RUNSTONE_OK);
    const auto corners_before = corner_bytes(mesh.get());
    CHECK(corners_before == std::vector<std::uint8_t>(plain.opaque.quads.size(), 0));
    REQUIRE(runstone_mesh_occlude(mesh.get(), handles[13].get(), pointers.data(),
                                  visibility.get()) == RUNSTONE_OK);
    std::vector<std::uint64_t> packed;
    for (const Quad quad : expected.quads.quads) packed.push_back(quad.bits);
    CHECK(packed_quads(mesh.get()) == packed);
    CHECK(corner_bytes(mesh.get()) == expected.corners);
    // Vertices have the values of their corners, from the first corner of the diagonal on.
    const auto vertices = cube_vertices(mesh.get());
    REQUIRE(vertices.size() == 4 * packed.size());
    bool same = true;
    for (std::size_t q = 0; q < packed.size(); ++q) {
      const auto corners = quad_corners(expected.quads.quads[q]);
      for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t corner = (first_corner(expected.corners[q]) + i) % 4;
        const runstone_vertex& vertex = vertices[4 * q + i];
        same = same && vertex.occlusion == occlusion_of(expected.corners[q], corner);
        for (std::size_t axis = 0; axis < 3; ++axis)
          same = same && vertex.position[axis] == static_cast<float>(corners[corner][axis]);
      }
    }
    CHECK(same);
    // The next mesh has none.
    REQUIRE(runstone_mesh_chunk(mesh.get(), handles[13].get(), beside.data(), nullptr,
                                visibility.get()) == RUNSTONE_OK);
    CHECK(packed_quads(mesh.get()).size() == plain.opaque.quads.size());
  }
}

TEST_CASE("occlusion is refused for another chunk, neighbour or visibility", "[c_interface]") {
  const auto visibility = visibility_handle(kKindsOfRows), other = visibility_handle(kKindsOfRows);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  const auto chunk = handle_of(uniform_chunk(Extent::cube(16), 1));
  const auto larger = handle_of(uniform_chunk(Extent::cube(32), 1));
  std::array<const runstone_chunk*, 27> around{};
  const auto status = [&](const Owned<runstone_visibility>& with) {
    return runstone_mesh_occlude(mesh.get(), chunk.get(), around.data(), with.get());
  };
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);  // nothing was meshed
  REQUIRE(runstone_mesh_chunk(mesh.get(), chunk.get(), nullptr, nullptr, visibility.get()) ==
          RUNSTONE_OK);
  CHECK(status(visibility) == RUNSTONE_OK);
  CHECK(status(other) == RUNSTONE_BAD_ARGUMENT);
  around[0] = larger.get();  // a corner may have any sides
  CHECK(status(visibility) == RUNSTONE_OK);
  around[9] = larger.get();  // an edge has those of the chunk along it
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  around[9] = nullptr;
  around[14] = chunk.get();  // not the neighbour of the mesh
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  around[14] = nullptr;
  around[0] = reinterpret_cast<const runstone_chunk*>(mesh.get());
  CHECK(status(visibility) == RUNSTONE_BAD_HANDLE);
  around[0] = nullptr;
  REQUIRE(runstone_chunk_fill(chunk.get(), 0, 1, 2) == RUNSTONE_OK);
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  std::size_t count = 0;
  CHECK(runstone_mesh_occlusion(mesh.get(), 2, nullptr, 0, &count) == RUNSTONE_BAD_ARGUMENT);
}

}  // namespace runstone::test
