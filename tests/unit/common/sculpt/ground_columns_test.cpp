#include "common/sculpt/ground_columns.hpp"

#include <catch2/catch.hpp>
#include <map>

#include "common/core/hash.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kEdge = 16;

struct RandomWorld {
  explicit RandomWorld(std::uint64_t seed) {
    SplitMix64 rng(seed);
    for (std::int32_t x = -2; x < 2; ++x) {
      for (std::int32_t y = -2; y < 2; ++y) {
        for (std::int32_t z = -2; z < 2; ++z) {
          chunks[{x, y, z}] = std::make_shared<RunChunk>(
              random_chunk(rng, Extent::cube(kEdge), random_order(rng), 4,
                           rng.below(2) == 0 ? ChunkShape::boxes : ChunkShape::spheres));
        }
      }
    }
  }
  std::shared_ptr<const RunChunk> operator()(ChunkCoord at) const {
    const auto found = chunks.find(at);
    return found == chunks.end() ? nullptr : found->second;
  }
  std::map<ChunkCoord, std::shared_ptr<const RunChunk>> chunks;
};

}  // namespace

TEST_CASE("columns hold the voxels of their chunks, in every axis order", "[sculpt]") {
  const RandomWorld world(GENERATE(1U, 2U, 3U));
  const VoxelBox box{{-21, -30, -9}, {17, 25, 31}};
  const auto columns = GroundColumns::read(box, kEdge, world);
  REQUIRE(columns);
  REQUIRE(columns->count() == 38U * 40U);
  for (std::int32_t z = box.min.z; z < box.max.z; ++z) {
    for (std::int32_t x = box.min.x; x < box.max.x; ++x) {
      const auto column = columns->column(columns->index(x, z));
      REQUIRE_FALSE(column.empty());
      CHECK(column.back().end == box.max.y);
      for (std::size_t i = 1; i < column.size(); ++i) {
        CHECK(column[i - 1].end < column[i].end);
        CHECK(column[i - 1].material != column[i].material);
      }
      for (std::int32_t y = box.min.y; y < box.max.y; ++y) {
        const VoxelPos at{x, y, z};
        const Material real = material_at(*world(chunk_of(at, kEdge)), local_of(at, kEdge));
        if (material_in_column(column, y) != real) FAIL_CHECK(x << " " << y << " " << z);
      }
    }
  }
}

TEST_CASE("a column with a chunk that is not known has no runs", "[sculpt]") {
  RandomWorld world(4);
  world.chunks.erase({0, -1, 0});
  const auto columns = GroundColumns::read({{-4, -20, -4}, {4, 20, 4}}, kEdge, world);
  REQUIRE(columns);
  CHECK(columns->column(columns->index(0, 0)).empty());
  CHECK_FALSE(columns->column(columns->index(-1, 0)).empty());
}

TEST_CASE("an area beyond the bound is refused", "[sculpt]") {
  const auto none = [](ChunkCoord) { return std::shared_ptr<const RunChunk>(); };
  const auto columns = GroundColumns::read({{0, 0, 0}, {1025, 8, 1024}}, kEdge, none);
  REQUIRE_FALSE(columns);
  CHECK(columns.error().code == ErrorCode::limit_exceeded);
  CHECK(GroundColumns::read({{0, 0, 0}, {1024, 8, 1024}}, kEdge, none));
}

}  // namespace runstone::test
