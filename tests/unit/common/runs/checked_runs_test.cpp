#include "common/runs/checked_runs.hpp"

#include <catch2/catch.hpp>

#include "common/runs/cut.hpp"
#include "common/runs/dense.hpp"

using namespace runstone;

TEST_CASE("sides of a chunk from data are 8 to 128 voxels", "[runs]") {
  CHECK(*chunk_extent(8, 128, 32) == Extent{8, 128, 32});
  for (const unsigned side : {0u, 1u, 7u, 129u, 256u + 32u, 4'000'000'000u}) {
    CAPTURE(side);
    CHECK_FALSE(chunk_extent(side, 32, 32).has_value());
    CHECK_FALSE(chunk_extent(32, side, 32).has_value());
    CHECK_FALSE(chunk_extent(32, 32, side).has_value());
  }
}

TEST_CASE("an array of another size, edge or order is no chunk", "[runs]") {
  const std::vector<Material> voxels(32 * 32 * 32 + 1);
  const std::span<const Material> all(voxels);
  CHECK(from_dense(Extent::cube(32), AxisOrder::xyz, all.first(32 * 32 * 32)).has_value());
  CHECK_FALSE(from_dense(Extent::cube(32), AxisOrder::xyz, all).has_value());
  CHECK_FALSE(from_dense(Extent::cube(32), AxisOrder::xyz, all.first(32)).has_value());
  CHECK_FALSE(from_dense(Extent::cube(4), AxisOrder::xyz, all.first(64)).has_value());
  CHECK_FALSE(from_dense(Extent{0, 8, 8}, AxisOrder::xyz, {}).has_value());
  CHECK_FALSE(
      from_dense(Extent::cube(32), static_cast<AxisOrder>(6), all.first(32 * 32 * 32)).has_value());
}

TEST_CASE("a fill beyond the end of a chunk fails and changes nothing", "[runs]") {
  RunChunk chunk = uniform_chunk(Extent::cube(16), kEmpty);
  const RunChunk before = chunk;
  const std::uint32_t volume = chunk.volume();
  for (const auto& [first, count] :
       std::vector<std::pair<std::uint32_t, std::uint32_t>>{{0, 0},
                                                            {0, volume + 1},
                                                            {volume, 1},
                                                            {volume - 1, 2},
                                                            {1, UINT32_MAX},
                                                            {UINT32_MAX, 1}}) {
    CAPTURE(first, count);
    const auto filled = try_fill(chunk, first, count, 5);
    REQUIRE_FALSE(filled.has_value());
    CHECK(filled.error().code == ErrorCode::bad_value);
    CHECK(chunk == before);
  }
  EditArea area;
  CHECK(*try_fill(chunk, volume - 1, 1, 5, &area));
  CHECK_FALSE(*try_fill(chunk, volume - 1, 1, 5));
  CHECK(area.after == 2);
  CHECK(*try_material_at(chunk, {15, 15, 15}) == 5);
  CHECK_FALSE(try_material_at(chunk, {16, 0, 0}).has_value());
  CHECK_FALSE(try_material_at(chunk, {0, 255, 0}).has_value());
}

TEST_CASE("a cuboid that reaches out of a chunk is not copied", "[runs]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(16), 3);
  CHECK(*try_cut(chunk, {8, 0, 0}, {8, 16, 1}) == cut(chunk, {8, 0, 0}, {8, 16, 1}));
  CHECK_FALSE(try_cut(chunk, {9, 0, 0}, {8, 1, 1}).has_value());
  CHECK_FALSE(try_cut(chunk, {0, 255, 0}, {1, 128, 1}).has_value());
  CHECK_FALSE(try_cut(chunk, {0, 0, 0}, {1, 0, 1}).has_value());
}

TEST_CASE("a chunk or part with sides out of range is invalid, and no assertion", "[runs]") {
  RunChunk chunk = uniform_chunk(Extent::cube(16), 3);
  for (const Extent extent : {Extent{0, 16, 16}, Extent{16, 200, 16}}) {
    chunk.extent = extent;
    CHECK_FALSE(validate(chunk).has_value());
    CHECK_FALSE(validate_runs(chunk).has_value());
  }
  CHECK_FALSE(validate(uniform_chunk(Extent::cube(4), 3)).has_value());
}
