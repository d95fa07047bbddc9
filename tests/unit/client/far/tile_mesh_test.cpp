#include "client/far/tile_mesh.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "client/far/stand_in.hpp"
#include "common/materials/material_table.hpp"
#include "tests/support/mesh/face_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using namespace runstone::test;

namespace {

/// Returns the faces of a body whose outside is empty, without the lower transparent faces on its
/// border, without the upper ones below the same material of `above`, if that is not null, and without
/// the lateral ones that have the same material above.
std::vector<UnitFace> closed_faces(const RunChunk& body, const RunChunk* above,
                                   const MaterialTable& materials) {
  const DenseChunk dense = DenseChunk::of(body);
  const DenseChunk over = DenseChunk::of(above == nullptr ? body : *above);
  std::vector<UnitFace> out = exposed_faces(dense, {}, materials);
  const int last = body.extent.x - 1;
  std::erase_if(out, [&](const UnitFace& face) {
    if (!materials.knows(face.material) ||
        materials[face.material].visibility == Visibility::opaque)
      return false;
    if (face.direction == Direction::neg_y) return face.y == 0;
    if (face.direction == Direction::pos_y && face.y == last && above != nullptr)
      return over.at(face.x, 0, face.z) == face.material;
    const bool is_lateral = (face.direction == Direction::neg_x && face.x == 0) ||
                            (face.direction == Direction::pos_x && face.x == last) ||
                            (face.direction == Direction::neg_z && face.z == 0) ||
                            (face.direction == Direction::pos_z && face.z == last);
    return is_lateral && face.y < last && dense.at(face.x, face.y + 1, face.z) == face.material;
  });
  return out;
}

}  // namespace

TEST_CASE("water loses its walls on the sides that distant ground continues", "[far]") {
  const MaterialTable materials = default_material_table();
  const auto water = materials.find("water");
  REQUIRE(water.has_value());
  constexpr std::int32_t kEdge = 16;
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(uniform_chunk(Extent::cube(kEdge), *water), {}, VisibilityTable(visibilities(materials)),
           scratch, mesh);
  const auto has_wall = [&](Direction d) {
    return !mesh.transparent.layer(d, is_positive(d) ? kEdge - 1 : 0).empty();
  };
  for (unsigned d = 0; d < 6; ++d) REQUIRE(has_wall(static_cast<Direction>(d)));
  CHECK_FALSE(drop_water_walls(mesh, kEdge, 0));
  CHECK(drop_water_walls(mesh, kEdge, 0b111111));
  for (unsigned d = 0; d < 6; ++d) {
    const auto direction = static_cast<Direction>(d);
    CHECK(has_wall(direction) == (direction == Direction::pos_y));  // the surface stays
  }
}

TEST_CASE("the whole of a tile and each octant are closed bodies", "[far][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  CAPTURE(Catch::rngSeed());
  const MaterialTable materials = default_material_table();
  const VisibilityTable visibility(visibilities(materials));
  RdmScratch scratch;
  for (int round = 0; round < 40; ++round) {
    const auto edge = static_cast<unsigned>(round % 2 == 0 ? 32 : 16);
    const auto tile = std::make_shared<const RunChunk>(random_chunk(
        rng, Extent::cube(edge), random_order(rng), static_cast<unsigned>(materials.size())));
    const FarMeshResult made = mesh_tile({{2, {0, 0, 0}}, 9, tile, true}, visibility, scratch);
    CHECK(made.number == 9);
    CHECK(made.edge == static_cast<std::int32_t>(edge));
    REQUIRE_FALSE(mesh_difference(made.mesh->whole, tile->extent, materials,
                                  closed_faces(*tile, nullptr, materials)));
    if (made.mesh->empty()) continue;
    REQUIRE(made.mesh->octants.size() == 8);
    for (unsigned i = 0; i < 8; ++i) {
      const RunChunk part = cut_octant(*tile, i), above = cut_octant(*tile, i | 2U);
      REQUIRE_FALSE(
          mesh_difference(made.mesh->octants[i], part.extent, materials,
                          closed_faces(part, (i & 2U) == 0 ? &above : nullptr, materials)));
    }
  }
}
