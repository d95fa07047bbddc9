#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "common/core/hash.hpp"
#include "common/mesh/chunk_mesher.hpp"
#include "common/shapes/shape_kinds.hpp"
#include "tests/support/runs/random_chunk.hpp"
#include "tests/unit/bindings/c/owned_handle.hpp"

namespace runstone::test {
namespace {

constexpr std::uint16_t kSlab = 3, kPlant = 4;

Owned<runstone_shapes> slab_and_plant() {
  auto shapes = owned<runstone_shapes>(runstone_shapes_create);
  REQUIRE(runstone_shapes_add_kind(shapes.get(), kSlab, "slab", nullptr) == RUNSTONE_OK);
  const runstone_local_box plant{{1, 0, 1}, {15, 12, 15}};
  REQUIRE(runstone_shapes_add(shapes.get(), kPlant, RUNSTONE_SHAPE_CROSSED, &plant, 1) ==
          RUNSTONE_OK);
  return shapes;
}

Owned<runstone_visibility> shaped_visibility(const std::vector<std::uint8_t>& rows,
                                             const runstone_shapes* shapes) {
  return owned<runstone_visibility>([&](runstone_visibility** out) {
    return runstone_visibility_create_with_shapes(rows.data(), rows.size(), shapes, out);
  });
}

const std::vector<std::uint8_t> kRows = {RUNSTONE_EMPTY, RUNSTONE_OPAQUE, RUNSTONE_TRANSPARENT,
                                         RUNSTONE_OPAQUE, RUNSTONE_TRANSPARENT};

/// The properties of the same materials that meshers of the C++ libraries read.
MeshMaterials shaped_materials() {
  using enum Visibility;
  MeshMaterials out(VisibilityTable(std::array{empty, opaque, transparent, opaque, transparent}));
  out.cubes = VisibilityTable(std::array{empty, opaque, transparent, empty, empty});
  std::vector<Shape> shapes(5);
  shapes[kSlab] = *shape_of_kind("slab", "");
  shapes[kPlant] = {ShapeForm::crossed, {{{1, 0, 1}, {15, 12, 15}}}};
  out.shapes = ShapeTable(shapes);
  return out;
}

std::vector<std::uint64_t> shape_quads(const runstone_mesh* mesh, std::uint32_t pass) {
  return fetched<std::uint64_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_shape_quads(mesh, pass, out, room, n);
  });
}

std::vector<runstone_vertex> shape_vertices(const runstone_mesh* mesh, std::uint32_t pass) {
  return fetched<runstone_vertex>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_shape_vertices(mesh, pass, out, room, n);
  });
}

}  // namespace

TEST_CASE("quads of shapes of the C interface are those of the mesher", "[c_interface]") {
  SplitMix64 rng{71};
  const auto shapes = slab_and_plant();
  const auto visibility = shaped_visibility(kRows, shapes.get());
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  const MeshMaterials materials = shaped_materials();
  ChunkMeshScratch scratch;
  std::size_t quads = 0;
  for (int round = 0; round < 20; ++round) {
    CAPTURE(round);
    RunChunk chunk = random_chunk(rng, Extent::cube(16), random_order(rng), 2);
    for (int i = 0; i < 200; ++i)
      fill(chunk, rng.below(chunk.volume() - 4), 1 + rng.below(4),
           static_cast<Material>(rng.below(5)));
    ChunkMesh expected;
    mesh_chunk(chunk, {}, {}, materials, scratch, expected);
    const auto handle = handle_of(chunk);
    REQUIRE(runstone_mesh_chunk(mesh.get(), handle.get(), nullptr, nullptr, visibility.get()) ==
            RUNSTONE_OK);
    for (const std::uint32_t pass : {0U, 1U}) {
      const auto& of = pass == 0 ? expected.shapes.opaque : expected.shapes.transparent;
      std::vector<std::uint64_t> bits;
      for (const Quad quad : of) bits.push_back(quad.bits);
      CHECK(shape_quads(mesh.get(), pass) == bits);
      CHECK(shape_vertices(mesh.get(), pass).size() == 4 * of.size());
      quads += of.size();
    }
  }
  CHECK(quads > 100);
}

TEST_CASE("vertices of shapes lie on the shape and face outwards", "[c_interface]") {
  const auto shapes = slab_and_plant();
  const auto visibility = shaped_visibility(kRows, shapes.get());
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  RunChunk chunk = uniform_chunk(Extent::cube(8), kEmpty);
  fill(chunk, index_of({2, 3, 4}, chunk.extent, chunk.order), 2, kSlab);
  fill(chunk, index_of({6, 1, 1}, chunk.extent, chunk.order), 1, kPlant);
  const auto handle = handle_of(chunk);
  REQUIRE(runstone_mesh_chunk(mesh.get(), handle.get(), nullptr, nullptr, visibility.get()) ==
          RUNSTONE_OK);
  // Two slabs side by side have six faces, from 2 to 4 along x and half a voxel high.
  const auto slab = shape_vertices(mesh.get(), RUNSTONE_PASS_OPAQUE);
  REQUIRE(slab.size() == 4 * 6);
  float low[3] = {9, 9, 9}, high[3] = {0, 0, 0};
  for (const runstone_vertex& vertex : slab) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], vertex.position[axis]);
      high[axis] = std::max(high[axis], vertex.position[axis]);
    }
    CHECK(vertex.material == kSlab);
    CHECK(vertex.occlusion == 0);
  }
  CHECK(low[0] == 2.0F);
  CHECK(high[0] == 4.0F);
  CHECK(low[1] == 3.0F);
  CHECK(high[1] == 3.5F);
  CHECK(low[2] == 4.0F);
  CHECK(high[2] == 5.0F);
  // A plant has two planes with two sides each.
  const auto plant = shape_vertices(mesh.get(), RUNSTONE_PASS_TRANSPARENT);
  REQUIRE(plant.size() == 4 * 4);
  const auto indices = fetched<std::uint32_t>([&](auto* out, std::size_t room, std::size_t* n) {
    return runstone_mesh_shape_indices(mesh.get(), RUNSTONE_PASS_TRANSPARENT, out, room, n);
  });
  REQUIRE(indices.size() == 6 * 4);
  for (const auto* vertices : {&slab, &plant}) {
    for (std::size_t first = 0; first < vertices->size(); first += 4) {
      const runstone_vertex* const v = vertices->data() + first;
      // The normal is that of the triangle, and of length 1.
      float cross[3], length = 0, dot = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        cross[i] = (v[1].position[j] - v[0].position[j]) * (v[2].position[k] - v[0].position[k]) -
                   (v[1].position[k] - v[0].position[k]) * (v[2].position[j] - v[0].position[j]);
        length += cross[i] * cross[i];
        dot += cross[i] * v[0].normal[i];
      }
      CHECK(dot == Approx(std::sqrt(length)));
    }
  }
  runstone_quad_fields fields{};
  fields.struct_size = sizeof fields;
  REQUIRE(runstone_quad_unpack(shape_quads(mesh.get(), 0).front(), &fields) == RUNSTONE_OK);
  CHECK(fields.face != 0);
  // A program that was compiled before the field was added.
  runstone_quad_fields old{};
  old.struct_size = offsetof(runstone_quad_fields, face);
  old.face = 77;
  REQUIRE(runstone_quad_unpack(shape_quads(mesh.get(), 0).front(), &old) == RUNSTONE_OK);
  CHECK(old.material == kSlab);
  CHECK(old.face == 77);
}

TEST_CASE("shapes that no material can have are refused with words", "[c_interface]") {
  const auto shapes = owned<runstone_shapes>(runstone_shapes_create);
  const runstone_local_box whole{{0, 0, 0}, {16, 16, 16}}, empty{{4, 4, 4}, {4, 5, 5}},
      outside{{0, 0, 0}, {17, 1, 1}};
  const auto add = [&](std::uint16_t material, std::uint32_t form, const runstone_local_box& box,
                       std::size_t count = 1) {
    return runstone_shapes_add(shapes.get(), material, form, &box, count);
  };
  CHECK(add(0, 0, whole) == RUNSTONE_BAD_ARGUMENT);
  CHECK(add(1, 2, whole) == RUNSTONE_BAD_ARGUMENT);
  CHECK(add(1, 0, empty) == RUNSTONE_BAD_VALUE);
  CHECK(add(1, 0, outside) == RUNSTONE_BAD_VALUE);
  CHECK(add(1, 0, whole, 0) == RUNSTONE_BAD_VALUE);
  CHECK(add(1, 0, whole, 33) == RUNSTONE_BAD_ARGUMENT);
  CHECK(runstone_shapes_add_kind(shapes.get(), 1, "sofa", "") == RUNSTONE_BAD_ARGUMENT);
  CHECK(std::string(runstone_last_error()).find("kind") != std::string::npos);
  CHECK(runstone_shapes_add_kind(shapes.get(), 0, "slab", "") == RUNSTONE_BAD_ARGUMENT);
  // A kind whose states make a cube takes the shape away.
  const auto mesh = owned<runstone_mesh>(runstone_mesh_create);
  const auto chunk = handle_of(uniform_chunk(Extent::cube(8), 1));
  const auto cube_quads = [&](const char* states) {
    REQUIRE(runstone_shapes_add_kind(shapes.get(), 1, "slab", states) == RUNSTONE_OK);
    const auto visibility = shaped_visibility({}, shapes.get());
    REQUIRE(runstone_mesh_chunk(mesh.get(), chunk.get(), nullptr, nullptr, visibility.get()) ==
            RUNSTONE_OK);
    std::size_t count = 0;
    REQUIRE(runstone_mesh_quads(mesh.get(), 0, nullptr, 0, &count) == RUNSTONE_OK);
    return count;
  };
  CHECK(cube_quads("type=top") == 0);
  CHECK(cube_quads("type=double") == 6);
}

}  // namespace runstone::test
