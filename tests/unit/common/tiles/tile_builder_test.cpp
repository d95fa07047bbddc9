#include "common/tiles/tile_builder.hpp"

#include <catch2/catch.hpp>
#include <utility>

#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/tiles/tile_oracle.hpp"

namespace runstone::test {
namespace {

constexpr unsigned kEdge = 16;

RunChunk tile_of(const Children& children, AxisOrder order = AxisOrder::zxy) {
  TileScratch scratch;
  return build_tile(children, kEdge, order, mesh_visibility(), scratch);
}

RunChunk tile_of_voxels(const std::function<Material(int x, int y, int z)>& material) {
  return tile_of(children_of(kEdge, AxisOrder::zxy, material).pointers());
}

}  // namespace

TEST_CASE("a tile of equal uniform children is uniform", "[tiles]") {
  const RunChunk empty = uniform_chunk(Extent::cube(kEdge), kEmpty, AxisOrder::zxy);
  const RunChunk stone = uniform_chunk(Extent::cube(kEdge), kStone, AxisOrder::zxy);
  CHECK(tile_of({}) == empty);
  CHECK(tile_of({&empty, nullptr, &empty}) == empty);
  CHECK(tile_of({&stone, &stone, &stone, &stone, &stone, &stone, &stone, &stone}) == stone);
}

TEST_CASE("a child that is null is empty", "[tiles]") {
  const RunChunk stone = uniform_chunk(Extent::cube(kEdge), kStone);
  for (std::size_t i = 0; i < 8; ++i) {
    Children children{};
    children[i] = &stone;
    const RunChunk tile = tile_of(children);
    for (std::uint8_t corner = 0; corner < 8; ++corner) {
      const auto place = [](int bit) { return static_cast<std::uint8_t>(bit != 0 ? 15 : 0); };
      const LocalPos at{place(corner & 1), place(corner & 2), place(corner & 4)};
      CHECK(material_at(tile, at) == (corner == i ? kStone : kEmpty));
    }
  }
}

TEST_CASE("a single voxel stays, wherever it lies in its cell", "[tiles]") {
  for (const AxisOrder order : kAxisOrders) {
    for (int i = 0; i < 8; ++i) {
      const int vx = 14 + (i & 1), vy = 8 + (i >> 1 & 1), vz = 20 + (i >> 2);
      const ChildChunks children = children_of(kEdge, order, [&](int x, int y, int z) {
        return x == vx && y == vy && z == vz ? kStone : kEmpty;
      });
      RunChunk expected = uniform_chunk(Extent::cube(kEdge), kEmpty, order);
      fill(expected, index_of({7, 4, 10}, expected.extent, order), 1, kStone);
      CHECK(tile_of(children.pointers(), order) == expected);
    }
  }
}

TEST_CASE("a thin wall and a thin roof stay whole", "[tiles]") {
  const RunChunk wall = tile_of_voxels([](int x, int, int) { return x == 9 ? kStone : kEmpty; });
  const RunChunk roof = tile_of_voxels([](int, int y, int) { return y == 16 ? kDirt : kEmpty; });
  for (std::uint8_t i = 0; i < kEdge; ++i) {
    for (std::uint8_t k = 0; k < kEdge; ++k) {
      CHECK(material_at(wall, {4, i, k}) == kStone);
      CHECK(material_at(roof, {i, 8, k}) == kDirt);
    }
  }
  CHECK(material_at(wall, {3, 5, 5}) == kEmpty);
  CHECK(material_at(roof, {5, 7, 5}) == kEmpty);
}

TEST_CASE("the cover of the ground wins over what lies below it", "[tiles]") {
  const RunChunk tile = tile_of_voxels([](int, int y, int) {
    return y < 10 ? kStone : y == 10 ? kDirt : kEmpty;
  });
  CHECK(material_at(tile, {3, 4, 3}) == kStone);
  CHECK(material_at(tile, {3, 5, 3}) == kDirt);
  CHECK(material_at(tile, {3, 6, 3}) == kEmpty);
}

TEST_CASE("water over the ground stays, and hides the ground below it", "[tiles]") {
  // The ground's upper face is drawn through the water, and so is the water's.
  const RunChunk deep = tile_of_voxels([](int, int y, int) {
    return y < 10 ? kStone : y < 14 ? kWater : kEmpty;
  });
  CHECK(material_at(deep, {3, 4, 3}) == kStone);
  CHECK(material_at(deep, {3, 5, 3}) == kWater);
  CHECK(material_at(deep, {3, 6, 3}) == kWater);
  // In one cell both have one face: the upper one wins.
  const RunChunk shallow = tile_of_voxels([](int, int y, int) {
    return y < 11 ? kStone : y < 12 ? kWater : kEmpty;
  });
  CHECK(material_at(shallow, {3, 5, 3}) == kWater);
}

TEST_CASE("faces between equal transparent voxels do not count, between different ones they do",
          "[tiles]") {
  // A pane of glass in water has two faces for each voxel; the water beside it has one.
  const RunChunk tile = tile_of_voxels([](int x, int, int) { return x == 9 ? kGlass : kWater; });
  CHECK(material_at(tile, {4, 5, 5}) == kGlass);
  CHECK(material_at(tile, {3, 5, 5}) == kWater);
  const RunChunk in_glass =
      tile_of_voxels([](int x, int, int) { return x == 9 ? kWater : kGlass; });
  CHECK(material_at(in_glass, {4, 5, 5}) == kWater);
}

TEST_CASE("of equally exposed voxels the upper one wins, then lower x, then lower z", "[tiles]") {
  // A cell of eight materials in the open: all voxels have three faces.
  const auto material = [](int x, int y, int z) {
    const bool in_cell = x >> 1 == 3 && y >> 1 == 3 && z >> 1 == 3;
    return in_cell ? static_cast<Material>(10 + (x & 1) + 2 * (y & 1) + 4 * (z & 1)) : kEmpty;
  };
  for (const AxisOrder order : kAxisOrders) {
    const ChildChunks children = children_of(kEdge, order, material);
    CHECK(material_at(tile_of(children.pointers(), order), {3, 3, 3}) == 12);
  }
  // Without one voxel, its three neighbours have four faces.
  const auto without = [&](int gone) {
    return tile_of_voxels([&, gone](int x, int y, int z) {
      const Material id = material(x, y, z);
      return id == gone ? kEmpty : id;
    });
  };
  CHECK(material_at(without(12), {3, 3, 3}) == 16);  // neighbours 13, 16 and 10: lower x
  CHECK(material_at(without(10), {3, 3, 3}) == 12);
  CHECK(material_at(without(11), {3, 3, 3}) == 13);
  CHECK(material_at(without(15), {3, 3, 3}) == 17);
}

TEST_CASE("what lies outside of the children exposes nothing", "[tiles]") {
  // All voxels are opaque, so none is exposed and the upper ones win.
  const RunChunk closed = tile_of_voxels([](int, int y, int) { return y == 31 ? kDirt : kStone; });
  CHECK(material_at(closed, {0, 15, 0}) == kDirt);
  // A hole beside the cell exposes one lower voxel.
  const RunChunk open = tile_of_voxels([](int x, int y, int z) {
    if (y == 31) return kDirt;
    return x == 2 && y == 30 && z == 0 ? kEmpty : kStone;
  });
  CHECK(material_at(open, {0, 15, 0}) == kStone);
}

TEST_CASE("children in another axis order give the same tile", "[tiles]") {
  const auto material = [](int x, int y, int z) {
    return static_cast<Material>((x * 7 + y * 3 + z * 5) % 11 < 4 ? 1 + (x + z) % 4 : 0);
  };
  const ChildChunks base = children_of(kEdge, AxisOrder::zxy, material);
  const RunChunk expected = tile_of(base.pointers());
  ChildChunks mixed = base;
  for (std::size_t i = 0; i < 6; ++i)
    mixed.chunks[i] = std::move(children_of(kEdge, kAxisOrders[i], material).chunks[i]);
  CHECK(tile_of(mixed.pointers()) == expected);
}

}  // namespace runstone::test
