#include <array>
#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/mesh/rdm/rdm_mesher.hpp"
#include "common/tiles/tile_builder.hpp"
#include "common/tiles/veil.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

const std::vector<std::uint8_t> kKinds = {RUNSTONE_EMPTY, RUNSTONE_OPAQUE, RUNSTONE_TRANSPARENT,
                                          RUNSTONE_OPAQUE};

VisibilityTable cpp_table() {
  return VisibilityTable(std::array{Visibility::empty, Visibility::opaque, Visibility::transparent,
                                    Visibility::opaque});
}

std::vector<std::uint64_t> quads_of(const runstone_mesh* mesh, std::uint32_t pass) {
  return fetched<std::uint64_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_quads(mesh, pass, out, room, n);
  });
}

std::vector<std::uint64_t> bits_of(const std::vector<Quad>& quads) {
  std::vector<std::uint64_t> out;
  for (const Quad& quad : quads) out.push_back(quad.bits);
  return out;
}

/// A chunk and its six neighbours, of which some are missing.
struct Surrounded {
  explicit Surrounded(SplitMix64& rng) {
    chunk = handle_of(random_chunk(rng, Extent::cube(16), random_order(rng), 4));
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (rng.below(4) == 0) continue;
      around[d] = handle_of(random_chunk(rng, Extent::cube(16), random_order(rng), 4));
      pointers[d] = around[d].get();
    }
  }
  void edit(SplitMix64& rng, runstone_chunk* one) const {
    const auto edits = owned<runstone_edits>(runstone_edits_create);
    const runstone_brush brush{sizeof brush, RUNSTONE_MASK_EVERYTHING, 0,
                               static_cast<std::uint16_t>(rng.below(4))};
    const auto along = [&rng] { return static_cast<std::int32_t>(rng.below(16)); };
    REQUIRE(runstone_edits_add_sphere(edits.get(), {along(), along(), along()}, rng.below(3),
                                      &brush) == RUNSTONE_OK);
    REQUIRE(runstone_chunk_apply(one, {0, 0, 0}, edits.get(), nullptr) == RUNSTONE_OK);
  }

  Owned<runstone_chunk> chunk;
  std::array<Owned<runstone_chunk>, kDirectionCount> around;
  std::array<const runstone_chunk*, kDirectionCount> pointers{};
};

}  // namespace

TEST_CASE("quads of the C interface are those of the mesher", "[c_interface]") {
  SplitMix64 rng{41};
  const auto visibility = visibility_handle(kKinds);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  RdmScratch scratch;
  for (int round = 0; round < 30; ++round) {
    CAPTURE(round);
    const Extent extent = random_extent(rng);
    const RunChunk chunk = random_chunk(rng, extent, random_order(rng), 4);
    std::array<RunChunk, kDirectionCount> around;
    std::array<Owned<runstone_chunk>, kDirectionCount> handles;
    std::array<Owned<runstone_borders>, kDirectionCount> borders;
    std::array<const runstone_chunk*, kDirectionCount> pointers{};
    std::array<const runstone_borders*, kDirectionCount> kept{};
    MeshNeighbours neighbours{};
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      if (rng.below(3) == 0) continue;
      around[d] = random_chunk(rng, extent, random_order(rng), 4);
      neighbours[d] = &around[d];
      handles[d] = handle_of(around[d]);
      pointers[d] = handles[d].get();
      if (rng.below(2) == 0) continue;
      borders[d] = owned<runstone_borders>([&](runstone_borders** out) {
        return runstone_borders_create(handles[d].get(), visibility.get(), out);
      });
      kept[d] = borders[d].get();
    }
    ChunkMesh expected;
    mesh_rdm(chunk, neighbours, cpp_table(), scratch, expected);
    const auto handle = handle_of(chunk);
    REQUIRE(runstone_mesh_chunk(mesh.get(), handle.get(), pointers.data(), kept.data(),
                                visibility.get()) == RUNSTONE_OK);
    CHECK(quads_of(mesh.get(), RUNSTONE_PASS_OPAQUE) == bits_of(expected.opaque.quads));
    CHECK(quads_of(mesh.get(), RUNSTONE_PASS_TRANSPARENT) == bits_of(expected.transparent.quads));
    // The layers, one after another, are all quads.
    std::vector<std::uint64_t> by_layer;
    for (std::uint32_t d = 0; d < 6; ++d) {
      for (std::uint32_t layer = 0; layer < kSideMax; ++layer) {
        const auto some = fetched<std::uint64_t>([&](auto* out, std::size_t room, std::size_t* n) {
          return runstone_mesh_layer_quads(mesh.get(), 0, d, layer, out, room, n);
        });
        by_layer.insert(by_layer.end(), some.begin(), some.end());
      }
    }
    CHECK(by_layer == bits_of(expected.opaque.quads));
  }
}

TEST_CASE("vertices and indices are the corners of the quads", "[c_interface]") {
  SplitMix64 rng{42};
  const auto visibility = visibility_handle(kKinds);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  const auto handle =
      handle_of(random_chunk(rng, {8, 9, 10}, AxisOrder::yzx, 4, ChunkShape::boxes));
  REQUIRE(runstone_mesh_chunk(mesh.get(), handle.get(), nullptr, nullptr, visibility.get()) ==
          RUNSTONE_OK);
  const auto quads = quads_of(mesh.get(), RUNSTONE_PASS_OPAQUE);
  const auto vertices = fetched<runstone_vertex>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_vertices(mesh.get(), RUNSTONE_PASS_OPAQUE, out, room, n);
  });
  const auto indices = fetched<std::uint32_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_indices(mesh.get(), RUNSTONE_PASS_OPAQUE, out, room, n);
  });
  REQUIRE_FALSE(quads.empty());
  REQUIRE(vertices.size() == 4 * quads.size());
  REQUIRE(indices.size() == 6 * quads.size());
  for (std::size_t q = 0; q < quads.size(); ++q) {
    runstone_quad_fields fields{};
    fields.struct_size = sizeof fields;
    REQUIRE(runstone_quad_unpack(quads[q], &fields) == RUNSTONE_OK);
    const auto corners = quad_corners(Quad{quads[q]});
    float area = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const runstone_vertex& vertex = vertices[4 * q + i];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(vertex.position[axis] == static_cast<float>(corners[i][axis]));
        const bool along = axis == fields.direction / 2;
        CHECK(vertex.normal[axis] == (!along ? 0.0F : fields.direction % 2 == 1 ? 1.0F : -1.0F));
      }
      CHECK(vertex.material == fields.material);
      area = std::max(area, vertex.uv[0] * vertex.uv[1]);
    }
    CHECK(area == static_cast<float>(fields.width * fields.height));
    // The first triangle turns counter-clockwise around the normal.
    const auto& a = vertices[indices[6 * q]];
    const auto& b = vertices[indices[6 * q + 1]];
    const auto& c = vertices[indices[6 * q + 2]];
    float turn = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      turn += a.normal[i] * ((b.position[j] - a.position[j]) * (c.position[k] - a.position[k]) -
                             (b.position[k] - a.position[k]) * (c.position[j] - a.position[j]));
    }
    CHECK(turn > 0);
  }
}

TEST_CASE("an updated mesh has the quads of a new one", "[c_interface]") {
  SplitMix64 rng{43};
  const auto visibility = visibility_handle(kKinds);
  int in_part = 0;
  for (int scene = 0; scene < 6; ++scene) {
    Surrounded around(rng);
    const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
    const auto fresh = owned<runstone_mesh>(runstone_mesh_create);
    for (int step = 0; step < 14; ++step) {
      CAPTURE(scene, step);
      const auto d = rng.below(kDirectionCount);
      switch (rng.below(8)) {
        case 0:  // a neighbour appears or goes
          around.pointers[d] = around.pointers[d] == nullptr ? around.around[d].get() : nullptr;
          break;
        case 1:
          REQUIRE(runstone_chunk_reorder(around.chunk.get(), rng.below(6)) == RUNSTONE_OK);
          break;
        case 2:
          if (around.around[d]) around.edit(rng, around.around[d].get());
          break;
        case 3: {  // a clone goes on where its original stands
          around.chunk = owned<runstone_chunk>(
              [&](runstone_chunk** out) { return runstone_chunk_clone(around.chunk.get(), out); });
          around.edit(rng, around.chunk.get());
          break;
        }
        case 4:  // more edits than are remembered
          for (int i = 0; i < 12; ++i) around.edit(rng, around.chunk.get());
          break;
        default:
          around.edit(rng, around.chunk.get());
      }
      std::uint32_t is_whole = 2;
      REQUIRE(runstone_mesh_update(mesh.get(), around.chunk.get(), around.pointers.data(), nullptr,
                                   visibility.get(), &is_whole) == RUNSTONE_OK);
      REQUIRE(is_whole <= 1);
      in_part += is_whole == 0 ? 1 : 0;
      REQUIRE(runstone_mesh_chunk(fresh.get(), around.chunk.get(), around.pointers.data(), nullptr,
                                  visibility.get()) == RUNSTONE_OK);
      for (const std::uint32_t pass : {0U, 1U})
        CHECK(quads_of(mesh.get(), pass) == quads_of(fresh.get(), pass));
    }
  }
  CHECK(in_part > 0);
}

TEST_CASE("chunks and borders that do not fit a mesh are refused", "[c_interface]") {
  const auto visibility = visibility_handle(kKinds);
  const auto other_visibility = visibility_handle(kKinds);
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  const auto chunk = handle_of(uniform_chunk(Extent::cube(16), 1));
  const auto larger = handle_of(uniform_chunk(Extent::cube(32), 1));
  const auto deep = handle_of(uniform_chunk({32, 16, 16}, 1));
  const auto borders = owned<runstone_borders>([&](runstone_borders** out) {
    return runstone_borders_create(deep.get(), visibility.get(), out);
  });
  std::array<const runstone_chunk*, 6> neighbours{};
  std::array<const runstone_borders*, 6> kept{};
  const auto status = [&](const Owned<runstone_visibility>& with) {
    return runstone_mesh_chunk(mesh.get(), chunk.get(), neighbours.data(), kept.data(), with.get());
  };
  neighbours[0] = larger.get();
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  neighbours[0] = deep.get();  // deeper along x only, where they do not touch
  CHECK(status(visibility) == RUNSTONE_OK);
  kept[0] = borders.get();
  CHECK(status(visibility) == RUNSTONE_OK);
  CHECK(status(other_visibility) == RUNSTONE_BAD_ARGUMENT);
  kept[1] = borders.get();
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  kept[1] = nullptr;
  REQUIRE(runstone_chunk_fill(deep.get(), 0, 1, 2) == RUNSTONE_OK);
  CHECK(status(visibility) == RUNSTONE_BAD_ARGUMENT);
  kept[0] = nullptr;
  neighbours[0] = reinterpret_cast<const runstone_chunk*>(mesh.get());
  CHECK(status(visibility) == RUNSTONE_BAD_HANDLE);

  std::size_t count = 0;
  CHECK(runstone_mesh_quads(mesh.get(), 2, nullptr, 0, &count) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_mesh_layer_quads(mesh.get(), 0, 6, 0, nullptr, 0, &count) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_mesh_layer_quads(mesh.get(), 0, 0, 128, nullptr, 0, &count) ==
        RUNSTONE_BAD_ARGUMENT);
  runstone_quad_fields fields{};
  fields.struct_size = sizeof fields;
  CHECK(runstone_quad_unpack(std::uint64_t{6} << 35, &fields) == RUNSTONE_BAD_ARGUMENT);
  const std::uint8_t unknown = 3;
  runstone_visibility* out = nullptr;
  CHECK(runstone_visibility_create(&unknown, 1, &out) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_visibility_create(&unknown, 65537, &out) == RUNSTONE_BAD_ARGUMENT);
}

TEST_CASE("tiles of the C interface are those of the tile builder", "[c_interface]") {
  SplitMix64 rng{44};
  const auto visibility = visibility_handle(kKinds);
  TileScratch scratch;
  VeilScratch veil_scratch;
  std::array<RunChunk, 8> children;
  std::array<Owned<runstone_chunk>, 8> handles;
  std::array<const runstone_chunk*, 8> pointers{};
  TileChildren of{};
  for (std::size_t i = 1; i < 8; ++i) {
    children[i] = random_chunk(rng, Extent::cube(16), random_order(rng), 4, ChunkShape::spheres);
    of[i] = &children[i];
    handles[i] = handle_of(children[i]);
    pointers[i] = handles[i].get();
  }
  const auto tile = owned<runstone_chunk>([&](runstone_chunk** out) {
    return runstone_tile_build(pointers.data(), 16, RUNSTONE_ORDER_XZY, visibility.get(), out);
  });
  const RunChunk expected = build_tile(of, 16, AxisOrder::xzy, cpp_table(), scratch);
  CHECK(same_runs(tile.get(), expected));
  REQUIRE(runstone_tile_veil(tile.get(), visibility.get()) == RUNSTONE_OK);
  CHECK(same_runs(tile.get(), veiled(expected, cpp_table(), veil_scratch).value_or(expected)));

  runstone_chunk* out = nullptr;
  for (const std::uint32_t edge : {4U, 32U, 256U})
    CHECK(runstone_tile_build(pointers.data(), edge, 0, visibility.get(), &out) ==
          RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_tile_build(pointers.data(), 16, 6, visibility.get(), &out) ==
        RUNSTONE_BAD_ARGUMENT);
  CHECK(out == nullptr);
}

}  // namespace runstone::test
