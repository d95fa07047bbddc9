#include "common/runs/column_tops.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using test::DenseChunk;

namespace {

/// The oracle: looks at the voxels of each column, from above.
std::vector<ColumnTop> dense_tops(const DenseChunk& chunk, std::int32_t base_y,
                                  const ShowingMaterials& showing) {
  std::vector<ColumnTop> out;
  for (int z = 0; z < chunk.side_z(); ++z) {
    for (int x = 0; x < chunk.side_x(); ++x) {
      ColumnTop top;
      for (int y = chunk.side_y() - 1; y >= 0 && !top.is_found(); --y) {
        const Material id = chunk.at(x, y, z);
        if (id >= showing.size() || showing[id]) top = {base_y + y, id};
      }
      out.push_back(top);
    }
  }
  return out;
}

std::size_t found_in(const std::vector<ColumnTop>& tops) {
  return static_cast<std::size_t>(
      std::count_if(tops.begin(), tops.end(), [](const ColumnTop& t) { return t.is_found(); }));
}

std::vector<ColumnTop> open_columns(const RunChunk& chunk) {
  return std::vector<ColumnTop>(std::size_t{chunk.extent.x} * chunk.extent.z);
}

}  // namespace

TEST_CASE("the tops of random chunks are those of the dense oracle, in every axis order",
          "[runs][column_tops]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 40; ++round) {
    const unsigned side_max = round % 8 == 0 ? 128 : 24;
    const Extent extent = test::random_extent(rng, side_max);
    const auto materials = static_cast<unsigned>(1 + rng.next() % 6);
    ShowingMaterials showing;
    while (showing.size() < rng.next() % 8) showing.push_back(rng.next() % 2 == 0);
    if (!showing.empty()) showing[0] = false;
    const auto shape = static_cast<test::ChunkShape>(rng.next() % test::kShapeCount);
    for (const AxisOrder order : kAxisOrders) {
      const RunChunk chunk = test::random_chunk(rng, extent, order, materials, shape);
      CAPTURE(Catch::rngSeed(), round, static_cast<int>(order), static_cast<int>(shape));
      std::vector<ColumnTop> tops = open_columns(chunk);
      const std::size_t found = find_column_tops(chunk, -100, showing, tops);
      const std::vector<ColumnTop> expected = dense_tops(DenseChunk::of(chunk), -100, showing);
      REQUIRE(tops == expected);
      REQUIRE(found == found_in(expected));
    }
  }
}

TEST_CASE("a chunk below fills only the columns that are open", "[runs][column_tops]") {
  SplitMix64 rng{Catch::rngSeed()};
  const ShowingMaterials showing{false};
  for (const AxisOrder above_order : kAxisOrders) {
    for (const AxisOrder below_order : kAxisOrders) {
      const Extent extent{9, 16, 12};
      const RunChunk above =
          test::random_chunk(rng, extent, above_order, 3, test::ChunkShape::spheres);
      const RunChunk below =
          test::random_chunk(rng, extent, below_order, 3, test::ChunkShape::boxes);
      std::vector<ColumnTop> expected = dense_tops(DenseChunk::of(above), 16, showing);
      const std::vector<ColumnTop> under = dense_tops(DenseChunk::of(below), 0, showing);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        if (!expected[i].is_found()) expected[i] = under[i];
      }
      std::vector<ColumnTop> tops = open_columns(above);
      std::size_t found = find_column_tops(above, 16, showing, tops);
      found += find_column_tops(below, 0, showing, tops);
      CAPTURE(Catch::rngSeed(), static_cast<int>(above_order), static_cast<int>(below_order));
      REQUIRE(tops == expected);
      REQUIRE(found == found_in(expected));
    }
  }
}

TEST_CASE("the oracle of column tops notices a wrong column", "[runs][column_tops]") {
  RunChunk chunk = uniform_chunk(Extent::cube(8), kEmpty, AxisOrder::yxz);
  fill(chunk, index_of({3, 5, 2}, chunk.extent, chunk.order), 1, 7);
  std::vector<ColumnTop> tops = open_columns(chunk);
  CHECK(find_column_tops(chunk, 64, {false}, tops) == 1);
  CHECK(tops[3 + 8 * 2] == ColumnTop{69, 7});
  CHECK(tops == dense_tops(DenseChunk::of(chunk), 64, {false}));
  std::swap(tops[3 + 8 * 2], tops[2 + 8 * 3]);  // x and z mixed up
  CHECK(tops != dense_tops(DenseChunk::of(chunk), 64, {false}));
}

TEST_CASE("an empty chunk has no tops, and materials beyond the table show",
          "[runs][column_tops]") {
  for (const AxisOrder order : kAxisOrders) {
    const RunChunk air = uniform_chunk(Extent::cube(16), kEmpty, order);
    std::vector<ColumnTop> tops = open_columns(air);
    CHECK(find_column_tops(air, 0, {false}, tops) == 0);
    CHECK(found_in(tops) == 0);
    CHECK(find_column_tops(air, 0, {}, tops) == 256);  // nothing is known of material 0
    CHECK(tops[17] == ColumnTop{15, kEmpty});
  }
}
