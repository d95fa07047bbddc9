#include "common/runs/run_cursor.hpp"

#include <catch2/catch.hpp>

#include "common/runs/run_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;

namespace {

// Returns the first run that ends behind the voxel, by linear search.
std::size_t run_of(const RunList& runs, std::uint32_t voxel) {
  std::size_t i = 0;
  while (runs.end(i) <= voxel) ++i;
  return i;
}

}  // namespace

TEST_CASE("a cursor steps through every run", "[runs][cursor]") {
  SplitMix64 rng(1);
  const RunChunk chunk =
      test::random_chunk(rng, {8, 9, 10}, AxisOrder::zxy, 3, test::ChunkShape::noise);
  chunk.runs.visit([&](auto runs) {
    RunCursor cursor(runs);
    for (std::size_t i = 0; i < chunk.runs.size(); ++i) {
      CHECK(cursor.run() == i);
      CHECK(cursor.end() == chunk.runs.end(i));
      CHECK(cursor.material() == chunk.runs.material(i));
      CHECK(cursor.last() == (i + 1 == chunk.runs.size()));
      if (!cursor.last()) cursor.next();
    }
  });
}

TEST_CASE("find_run and a cursor's seek find the run of every voxel", "[runs][cursor]") {
  SplitMix64 rng(2);
  for (int round = 0; round < 40; ++round) {
    const RunChunk chunk = test::random_chunk(rng, 12, 4);
    chunk.runs.visit([&](auto runs) {
      std::size_t expected = 0;
      RunCursor walking(runs);
      for (std::uint32_t voxel = 0; voxel < chunk.volume(); ++voxel) {
        if (runs.end(expected) <= voxel) ++expected;
        REQUIRE(find_run(chunk, voxel) == expected);
        walking.seek(voxel);
        REQUIRE(walking.run() == expected);
      }
    });
  }
}

TEST_CASE("seeks of every distance from every kind of start land as a plain search does",
          "[runs][cursor]") {
  SplitMix64 rng(3);
  for (int round = 0; round < 30; ++round) {
    const RunChunk chunk = round % 5 == 4 ? test::random_chunk(rng, {40, 41, 42}, AxisOrder::yxz, 5,
                                                               test::ChunkShape::speckled)
                                          : test::random_chunk(rng, 16, 3);
    chunk.runs.visit([&](auto runs) {
      RunCursor cursor(runs);
      for (std::uint32_t voxel = 0; voxel < chunk.volume();) {
        cursor.seek(voxel);
        REQUIRE(cursor.run() == run_of(chunk.runs, voxel));
        cursor.seek(voxel);  // a seek to the current voxel stays
        REQUIRE(cursor.run() == run_of(chunk.runs, voxel));
        voxel += 1 + rng.below(1u << rng.below(14));
      }
      cursor.seek(chunk.volume() - 1);
      REQUIRE(cursor.last());
    });
  }
}

TEST_CASE("material_at reads single voxels in every order", "[runs][cursor]") {
  for (const AxisOrder order : kAxisOrders) {
    RunChunk chunk = uniform_chunk({8, 9, 10}, 1, order);
    fill(chunk, index_of({7, 8, 9}, chunk.extent, order), 1, 2);
    fill(chunk, index_of({0, 4, 2}, chunk.extent, order), 1, 3);
    CHECK(material_at(chunk, {7, 8, 9}) == 2);
    CHECK(material_at(chunk, {0, 4, 2}) == 3);
    CHECK(material_at(chunk, {0, 0, 0}) == 1);
  }
}
