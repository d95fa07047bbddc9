// The oracle of a mesh of layers is mesh_rdm(), which the face oracle checks elsewhere.
#include "common/mesh/rdm/layer_mesher.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <utility>

#include "tests/support/mesh/equal_quads.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

using rdm::LayerSet;
using Parts = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr MeshBorders kNoBorders{};

struct NoSteps {
  void operator()(rdm::LayerStep) const {}
};

LayerSet slow_layers(std::initializer_list<unsigned> layers) {
  LayerSet set;
  for (const unsigned layer : layers) set.set(layer);
  return set;
}

Parts parts_of(const LayerSet& slow) {
  Parts parts;
  rdm::LayerMesher<const NoSteps>::for_each_part(
      slow, [&](std::uint32_t begin, std::uint32_t end) { parts.emplace_back(begin, end); });
  return parts;
}

/// Meshes the layers of a change, whatever it costs.
void mesh_layers(const MeshScene& scene, const DirtyLayers& dirty,
                 const std::array<DirtyLayers, kDirectionCount>& beyond, RdmScratch& scratch,
                 ChunkMesh& mesh) {
  const MeshNeighbours around = scene.pointers();
  const rdm::TouchedLayers touched(scene.chunk, around, dirty, beyond);
  const NoSteps observer;
  rdm::LayerMesher(scene.chunk, around, kNoBorders, mesh_visibility(), scratch.state(), mesh,
                   observer)
      .run(touched);
}

void require_equal_meshes(const ChunkMesh& a, const ChunkMesh& b) {
  require_equal(a.opaque, b.opaque);
  require_equal(a.transparent, b.transparent);
}

TEST_CASE("a set of layers becomes a row of bits", "[mesh]") {
  const LayerSet set = slow_layers({0, 31, 32, 63, 64, 127});
  CHECK(rdm::row_of<Row32>(set & LayerSet(0xffffffffu)) == 0x80000001u);
  CHECK(rdm::row_of<Row64>(set & LayerSet(~0ULL)) == 0x8000000180000001u);
  const Row128 row = rdm::row_of<Row128>(set);
  CHECK(static_cast<Row64>(row) == 0x8000000180000001u);
  CHECK(static_cast<Row64>(row >> 64) == 0x8000000000000001u);
  CHECK(rdm::next_member(set, 0) == 0);
  CHECK(rdm::next_member(set, 1) == 31);
  CHECK(rdm::next_member(set, 33) == 63);
  CHECK(rdm::next_member(set, 65) == 127);
  CHECK(rdm::next_member(set, 128) == kSideMax);
  CHECK(rdm::next_member({}, 0) == kSideMax);
}

TEST_CASE("changed layers with less than three layers between them are one part", "[mesh]") {
  CHECK(parts_of({}).empty());
  CHECK(parts_of(slow_layers({0})) == Parts{{0, 1}});
  CHECK(parts_of(slow_layers({127})) == Parts{{127, 128}});
  CHECK(parts_of(slow_layers({3, 4, 5})) == Parts{{3, 6}});
  CHECK(parts_of(slow_layers({3, 6})) == Parts{{3, 7}});
  CHECK(parts_of(slow_layers({3, 7})) == Parts{{3, 4}, {7, 8}});
  CHECK(parts_of(slow_layers({0, 2, 5, 9, 127})) == Parts{{0, 6}, {9, 10}, {127, 128}});
  CHECK(parts_of(~LayerSet()) == Parts{{0, 128}});
}

TEST_CASE("layers that are meshed again without a change keep their quads", "[mesh]") {
  SplitMix64 rng(20261203);
  RdmScratch scratch;
  ChunkMesh mesh, full;
  for (const unsigned side : {8u, 32u, 33u, 64u, 128u}) {
    for (const AxisOrder order : kAxisOrders) {
      // The other sides have at most 16 voxels, so that the test is fast.
      std::array<std::uint8_t, 3> sides{};
      sides.fill(static_cast<std::uint8_t>(std::min(side, 16u)));
      sides.at(static_cast<std::size_t>(axes_of(order)[2])) = static_cast<std::uint8_t>(side);
      const MeshScene scene = scene_of_extent(rng, {sides[0], sides[1], sides[2]}, order);
      mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, full);
      mesh = full;
      const auto slow = static_cast<std::size_t>(axes_of(order)[2]);
      LayerSet all;
      for (unsigned layer = 0; layer < side; ++layer) all.set(layer);
      for (const LayerSet& layers :
           {LayerSet(), slow_layers({0}), slow_layers({1}), slow_layers({side / 2}),
            slow_layers({side - 2}), slow_layers({side - 1}), slow_layers({0, side - 1}),
            slow_layers({0, 3, 7}), slow_layers({0, 1, side - 2, side - 1}), all}) {
        DirtyLayers dirty;
        dirty.layer.at(slow) = layers;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          if (axis == slow || layers.none()) continue;
          for (unsigned layer = 0; layer < sides.at(axis); ++layer) dirty.layer.at(axis).set(layer);
        }
        std::array<DirtyLayers, kDirectionCount> beyond;
        beyond.fill(dirty);
        mesh_layers(scene, dirty, beyond, scratch, mesh);
        CAPTURE(side, order, layers);
        require_equal_meshes(mesh, full);
      }
    }
  }
}

TEST_CASE("a bar along the slowest axis is one quad a side when its gap is filled", "[mesh]") {
  RdmScratch scratch;
  ChunkMesh mesh, full;
  for (const unsigned side : {8u, 32u, 64u, 128u}) {
    for (const AxisOrder order : kAxisOrders) {
      std::array<std::uint8_t, 3> sides = {8, 8, 8};
      sides.at(static_cast<std::size_t>(axes_of(order)[2])) = static_cast<std::uint8_t>(side);
      const Extent extent = {sides[0], sides[1], sides[2]};
      const auto voxel = [&](unsigned s) {
        return index_of(from_ordered({3, 4, s}, order), extent, order);
      };
      for (const unsigned gap : {0u, 1u, side / 2 - 1, side / 2, side - 2, side - 1}) {
        MeshScene scene{uniform_chunk(extent, kEmpty, order), {}};
        for (unsigned s = 0; s < side; ++s) {
          if (s != gap) fill(scene.chunk, voxel(s), 1, kStone);
        }
        mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
        const std::size_t with_gap = gap == 0 || gap == side - 1 ? 6 : 12;
        CAPTURE(side, order, gap);
        REQUIRE(mesh.quad_count() == with_gap);
        // Filled with the same material the quads join, with another one they do not.
        for (const Material material : {kStone, kEmpty, kDirt, kEmpty, kWater, kEmpty}) {
          const DirtyLayers dirty = fill_and_mark(scene.chunk, voxel(gap), 1, material);
          mesh_layers(scene, dirty, {}, scratch, mesh);
          mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, full);
          CAPTURE(material);
          require_equal_meshes(mesh, full);
          if (material == kStone) CHECK(mesh.quad_count() == 6);
          if (material == kEmpty) CHECK(mesh.quad_count() == with_gap);
        }
      }
    }
  }
}

TEST_CASE("a wall is one quad when its hole is filled, across the border of a chunk too",
          "[mesh]") {
  // The wall fills a layer of the fastest, then of the middle axis, and a hole of one voxel is
  // filled. Neighbouring strips of the wall's sides join again.
  RdmScratch scratch;
  ChunkMesh mesh, full;
  for (const AxisOrder order : kAxisOrders) {
    for (const bool across_fast : {true, false}) {
      const Extent extent = Extent::cube(32);
      MeshScene scene{uniform_chunk(extent, kEmpty, order), {}};
      const auto voxel = [&](std::uint32_t along, std::uint32_t s) {
        const OrderedPos at = across_fast ? OrderedPos{31, along, s} : OrderedPos{along, 31, s};
        return index_of(from_ordered(at, order), extent, order);
      };
      for (std::uint32_t s = 0; s < 32; ++s) {
        for (std::uint32_t along = 0; along < 32; ++along)
          fill(scene.chunk, voxel(along, s), 1, kStone);
      }
      const Axis across = axes_of(order)[across_fast ? 0 : 1];
      const Direction beside = rdm::direction_of(across, true);
      auto& neighbour = scene.neighbours.at(static_cast<std::size_t>(beside));
      neighbour = uniform_chunk(extent, kEmpty, order);
      mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
      REQUIRE(mesh.quad_count() == 6);
      for (const auto& [along, s] : {std::pair{0u, 0u}, std::pair{31u, 31u}, std::pair{7u, 16u}}) {
        CAPTURE(order, across_fast, along, s);
        for (const Material material : {kEmpty, kStone}) {
          const DirtyLayers dirty = fill_and_mark(scene.chunk, voxel(along, s), 1, material);
          mesh_layers(scene, dirty, {}, scratch, mesh);
          mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, full);
          require_equal_meshes(mesh, full);
        }
        REQUIRE(mesh.quad_count() == 6);
        // A voxel of the neighbour hides a face of the wall, and shows it again.
        OrderedPos at = to_ordered(pos_of(voxel(along, s), extent, order), order);
        (across_fast ? at.f : at.m) = 0;
        for (const Material material : {kStone, kEmpty}) {
          std::array<DirtyLayers, kDirectionCount> beyond;
          beyond.at(static_cast<std::size_t>(beside)) = fill_and_mark(
              *neighbour, index_of(from_ordered(at, order), extent, order), 1, material);
          mesh_layers(scene, {}, beyond, scratch, mesh);
          mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, full);
          require_equal_meshes(mesh, full);
        }
        REQUIRE(mesh.quad_count() == 6);
      }
    }
  }
}

TEST_CASE("a part pays for one layer, and not for all layers or an empty chunk", "[mesh]") {
  SplitMix64 rng(20261204);
  const Extent extent = Extent::cube(32);
  MeshScene scene{random_chunk(rng, extent, AxisOrder::xyz, 3, ChunkShape::speckled), {}};
  RdmScratch scratch;
  ChunkMesh mesh;
  mesh_rdm(scene.chunk, scene.pointers(), mesh_visibility(), scratch, mesh);
  const auto pays = [&](unsigned begin, unsigned end) {
    DirtyLayers dirty;
    for (unsigned layer = begin; layer < end; ++layer) {
      for (auto& layers : dirty.layer) layers.set(layer);
    }
    const MeshNeighbours around = scene.pointers();
    const rdm::TouchedLayers touched(scene.chunk, around, dirty, {});
    const NoSteps observer;
    return rdm::LayerMesher(scene.chunk, around, kNoBorders, mesh_visibility(), scratch.state(),
                            mesh, observer)
        .pays(touched);
  };
  CHECK(pays(0, 1));
  CHECK(pays(15, 16));
  CHECK(pays(31, 32));
  CHECK_FALSE(pays(0, 32));
  scene.chunk = uniform_chunk(extent, kEmpty);
  CHECK_FALSE(pays(15, 16));
}

}  // namespace
}  // namespace runstone::test
