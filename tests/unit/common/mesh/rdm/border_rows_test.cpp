#include "common/mesh/rdm/border_rows.hpp"

#include <catch2/catch.hpp>
#include <memory>

#include "common/mesh/rdm/chunk_borders.hpp"
#include "common/runs/dense.hpp"
#include "tests/support/mesh/mesh_scene.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr unsigned kPlanes = 3;  // of materials 0 .. 7
rdm::PaletteIndex to_index(Material material) { return material & 7u; }

template <class Row>
void check_layers(const RunChunk& chunk) {
  const DenseChunk dense = DenseChunk::of(chunk);
  const auto sides = chunk.extent.sides();
  std::array<std::array<Row, kRowBits<Row>>, kPlanes> planes;
  for (unsigned a = 0; a < 3; ++a) {
    for (unsigned u = 0; u < 3; ++u) {
      if (u == a) continue;
      const unsigned v = 3 - a - u;
      for (const unsigned at : {0u, sides[a] / 2u, sides[a] - 1u}) {
        rdm::read_layer_rows(chunk, {static_cast<Axis>(a), static_cast<Axis>(u), at}, planes,
                             &to_index);
        std::size_t wrong = 0;
        for (unsigned row = 0; row < kRowBits<Row>; ++row) {
          for (unsigned bit = 0; bit < kRowBits<Row>; ++bit) {
            std::array<int, 3> p{};
            p[a] = static_cast<int>(at);
            p[u] = static_cast<int>(bit);
            p[v] = static_cast<int>(row);
            const bool inside = row < sides[v] && bit < sides[u];
            const rdm::PaletteIndex index = inside ? to_index(dense.at(p[0], p[1], p[2])) : 0;
            for (unsigned k = 0; k < kPlanes; ++k)
              wrong += (planes[k][row] >> bit & 1) != (index >> k & 1);
          }
        }
        CAPTURE(a, u, at, chunk.order);
        CHECK(wrong == 0);
      }
    }
  }
}

TEST_CASE("rows of every layer are its voxels in every orientation", "[mesh]") {
  SplitMix64 rng(41);
  for (int round = 0; round < 60; ++round) {
    check_layers<Row64>(random_chunk(rng, random_extent(rng, 20),
                                     kAxisOrders[static_cast<std::size_t>(round % 6)], 8));
  }
  for (const Extent extent : {Extent{32, 8, 31}, Extent{9, 32, 8}, Extent{32, 32, 32}}) {
    for (const AxisOrder order : kAxisOrders)
      check_layers<Row32>(random_chunk(rng, extent, order, 8));
  }
  for (const Extent extent : {Extent{64, 8, 63}, Extent{9, 64, 8}, Extent{8, 62, 64}}) {
    for (const AxisOrder order : kAxisOrders)
      check_layers<Row64>(random_chunk(rng, extent, order, 8));
  }
  for (const Extent extent : {Extent{128, 8, 65}, Extent{9, 128, 127}}) {
    for (const AxisOrder order : kAxisOrders)
      check_layers<Row128>(random_chunk(rng, extent, order, 8));
  }
}

TEST_CASE("rows of layers of many short runs are their voxels in every orientation", "[mesh]") {
  SplitMix64 rng(44);
  for (const AxisOrder order : kAxisOrders) {
    for (const ChunkShape shape :
         {ChunkShape::noise, ChunkShape::checkerboard, ChunkShape::speckled}) {
      check_layers<Row32>(random_chunk(rng, {32, 32, 32}, order, 2, shape));
      check_layers<Row32>(random_chunk(rng, {31, 9, 30}, order, 8, shape));
      check_layers<Row64>(random_chunk(rng, {64, 10, 33}, order, 2, shape));
      check_layers<Row128>(random_chunk(rng, {8, 128, 65}, order, 8, shape));
    }
  }
}

TEST_CASE("kept borders are the opaque voxels of the six sides", "[mesh]") {
  SplitMix64 rng(43);
  ChunkBorders borders;
  for (int round = 0; round < 120; ++round) {
    const MeshScene scene = random_scene(rng, round < 100 ? 40 : 128);
    const DenseChunk dense = DenseChunk::of(scene.chunk);
    const auto sides = scene.chunk.extent.sides();
    borders.read(scene.chunk, mesh_visibility());
    REQUIRE(borders.empty() == scene.chunk.is_uniform());
    if (borders.empty()) continue;
    for (unsigned d = 0; d < kDirectionCount; ++d) {
      const auto side = static_cast<Direction>(d);
      const unsigned a = d / 2;
      const auto u = static_cast<unsigned>(borders.bit_axis(side));
      const unsigned v = 3 - a - u;
      REQUIRE(borders.row_count(side) == sides[v]);
      std::size_t wrong = 0;
      bool transparent = false;
      for (unsigned row = 0; row < sides[v]; ++row) {
        for (unsigned bit = 0; bit < sides[u]; ++bit) {
          std::array<int, 3> p{};
          p[a] = is_positive(side) ? sides[a] - 1 : 0;
          p[u] = static_cast<int>(bit);
          p[v] = static_cast<int>(row);
          const Visibility visibility = mesh_visibility()[dense.at(p[0], p[1], p[2])];
          transparent |= visibility == Visibility::transparent;
          const std::uint32_t word = borders.rows(side)[row * borders.row_words(side) + bit / 32];
          wrong += (word >> bit % 32 & 1) != (visibility == Visibility::opaque ? 1 : 0);
        }
      }
      CAPTURE(round, d, scene.chunk.order);
      CHECK(wrong == 0);
      CHECK(borders.has_transparent(side) == transparent);
    }
  }
}

TEST_CASE("meshing makes no dense expansion", "[mesh]") {
  SplitMix64 rng(42);
  for (int round = 0; round < 30; ++round) {
    const MeshScene scene = random_scene(rng, 16);
    const std::uint64_t before = dense_expansions();
    mesh_of(scene);
    CHECK(dense_expansions() == before);
  }
}

}  // namespace
}  // namespace runstone::test
