#include "common/builds/basin_flood.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/core/hash.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/builds/cell_grid.hpp"

namespace runstone::test {
namespace {

constexpr std::int32_t kBasinEdge = 8;
constexpr Material kRock = 1, kPool = 2, kFilling = 3;

/// A box of chunks around the origin, voxel by voxel, some of them not known.
struct BasinWorld {
  VoxelPos low, sides;  // in voxels, multiples of the edge
  CellGrid cells;
  std::set<ChunkCoord> missing;

  bool is_known(VoxelPos at) const {
    return VoxelBox{low, {low.x + sides.x, low.y + sides.y, low.z + sides.z}}.contains(at) &&
           !missing.contains(chunk_of(at, kBasinEdge));
  }
  Material at(VoxelPos p) const {
    return cells.at({p.x - low.x, p.y - low.y, p.z - low.z}).value_or(kEmpty);
  }
  std::map<ChunkCoord, std::shared_ptr<const RunChunk>> chunks(SplitMix64& rng) const {
    std::map<ChunkCoord, std::shared_ptr<const RunChunk>> out;
    for_each_cell(
        {sides.x / kBasinEdge, sides.y / kBasinEdge, sides.z / kBasinEdge}, [&](VoxelPos c) {
          const VoxelPos first{low.x + c.x * kBasinEdge, low.y + c.y * kBasinEdge,
                               low.z + c.z * kBasinEdge};
          if (!is_known(first)) return;
          RunBuilder made(Extent::cube(kBasinEdge), AxisOrder::xyz);
          for_each_cell({kBasinEdge, kBasinEdge, kBasinEdge}, [&](VoxelPos v) {
            made.append(1, at({first.x + v.x, first.y + v.y, first.z + v.z}));
          });
          out.emplace(chunk_of(first, kBasinEdge),
                      std::make_shared<const RunChunk>(
                          reorder(made.finish(), kAxisOrders[rng.below(kAxisOrderCount)])));
        });
    return out;
  }
};

BasinWorld random_basins(SplitMix64& rng) {
  const auto side = [&] { return static_cast<std::int32_t>(1 + rng.below(3)) * kBasinEdge; };
  const auto corner = [&] { return static_cast<std::int32_t>(rng.below(3)) * -kBasinEdge; };
  const VoxelPos sides{side(), side(), side()};
  BasinWorld out{{corner(), corner(), corner()}, sides, CellGrid(sides), {}};
  // Rock with caves, or air with rocks: basins that are closed, and some that are not.
  const bool is_solid = rng.below(3) != 0;
  for_each_cell(sides, [&](VoxelPos c) {
    const bool is_shell = c.x == 0 || c.z == 0 || c.y == 0 || c.x + 1 == sides.x ||
                          c.y + 1 == sides.y || c.z + 1 == sides.z;
    const std::uint64_t draw = rng.below(100);
    Material m = draw < (is_solid ? 60U : 25U) ? kRock : draw < 85 ? kEmpty : kPool;
    if (is_shell && rng.below(200) != 0) m = kRock;
    out.cells.set(c, m);
  });
  if (rng.below(4) == 0) {
    const auto place = [&](std::int32_t from, std::int32_t along) {
      return from + static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(along)));
    };
    out.missing.insert(
        chunk_of({place(out.low.x, sides.x), place(out.low.y, sides.y), place(out.low.z, sides.z)},
                 kBasinEdge));
  }
  return out;
}

/// The flood voxel by voxel.
struct DenseFlood {
  std::set<VoxelPos> voxels;
  bool reaches_unknown = false;
};

DenseFlood dense_flood(const BasinWorld& world, const BasinFlood& flood) {
  DenseFlood out;
  std::vector<VoxelPos> waiting;
  const auto visit = [&](VoxelPos at) {
    if (at.y > flood.level) return;
    if (!world.is_known(at)) {
      out.reaches_unknown = true;
      return;
    }
    const Material m = world.at(at);
    if (m != kEmpty && (m >= flood.passes.size() || !flood.passes[m])) return;
    if (out.voxels.insert(at).second) waiting.push_back(at);
  };
  visit(flood.start);
  while (!waiting.empty()) {
    const VoxelPos p = waiting.back();
    waiting.pop_back();
    for (const VoxelPos step : {VoxelPos{1, 0, 0}, VoxelPos{-1, 0, 0}, VoxelPos{0, 1, 0},
                                VoxelPos{0, -1, 0}, VoxelPos{0, 0, 1}, VoxelPos{0, 0, -1}})
      visit({p.x + step.x, p.y + step.y, p.z + step.z});
  }
  return out;
}

}  // namespace

TEST_CASE("a basin in runs has the voxels of a flood voxel by voxel", "[builds][property]") {
  SplitMix64 rng(Catch::rngSeed() + 5050);
  std::size_t filled = 0, faults = 0;
  for (int round = 0; round < 400; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    const BasinWorld world = random_basins(rng);
    const auto chunks = world.chunks(rng);
    const auto place = [&](std::int32_t from, std::int32_t along) {
      return from + static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(along)));
    };
    BasinFlood flood;
    for (int tries = 0; tries < 5; ++tries) {
      flood.start = {place(world.low.x, world.sides.x), place(world.low.y, world.sides.y),
                     place(world.low.z, world.sides.z)};
      if (world.at(flood.start) != kRock) break;
    }
    flood.level = flood.start.y + static_cast<std::int32_t>(rng.below(7)) - 1;
    flood.material = kFilling;
    if (rng.below(2) == 0) flood.passes = {false, false, true};
    const DenseFlood expected = dense_flood(world, flood);
    std::set<VoxelPos> cells;
    for (const VoxelPos at : expected.voxels) {
      if (world.at(at) == kEmpty) cells.insert(at);
    }
    const auto count = static_cast<std::uint32_t>(expected.voxels.size());
    flood.voxels_max = rng.below(4) == 0 ? rng.below(count + 2) : 1'000'000;
    const auto made = flood_basin(flood, kBasinEdge, [&](ChunkCoord at) {
      const auto found = chunks.find(at);
      return found == chunks.end() ? nullptr : found->second;
    });
    if (!made) {
      ++faults;
      switch (made.error()) {
        case BasinFault::above_level:
          CHECK(flood.start.y > flood.level);
          break;
        case BasinFault::blocked:
          CHECK((flood.start.y <= flood.level && world.is_known(flood.start) && count == 0));
          break;
        case BasinFault::missing_chunk:
          CHECK(expected.reaches_unknown);
          break;
        case BasinFault::too_many_voxels:
          CHECK(count > flood.voxels_max);
          break;
        case BasinFault::full:
          CHECK((count != 0 && cells.empty()));
          break;
      }
      continue;
    }
    ++filled;
    CHECK(flood.start.y <= flood.level);
    CHECK_FALSE(expected.reaches_unknown);
    REQUIRE(count <= flood.voxels_max);
    CHECK(made->voxels == count);
    CHECK(broken_invariant(*made->build) == "");
    CHECK(made->build->touched() == cells.size());
    std::set<VoxelPos> got;
    const CellGrid grid = cells_of(*made->build);
    for_each_cell(grid.sides(), [&](VoxelPos c) {
      if (!grid.at(c)) return;
      CHECK(*grid.at(c) == kFilling);
      got.insert({made->at.x + c.x, made->at.y + c.y, made->at.z + c.z});
    });
    REQUIRE(got == cells);
    // A flood that stops one layer earlier is another one, unless the layer is full of rock.
    const bool has_top =
        std::any_of(cells.begin(), cells.end(), [&](VoxelPos at) { return at.y == flood.level; });
    --flood.level;
    CHECK((dense_flood(world, flood).voxels != expected.voxels || !has_top));
  }
  CHECK(filled > 40);
  CHECK(faults > 40);
}

TEST_CASE("a basin of many chunks stops at its limit of voxels", "[builds]") {
  const auto air =
      std::make_shared<const RunChunk>(uniform_chunk(Extent::cube(kBasinEdge), kEmpty));
  std::size_t asked = 0;
  const auto everywhere = [&](ChunkCoord) {
    ++asked;
    return air;
  };
  BasinFlood flood{{0, 0, 0}, kWorldLimit - 1, kFilling, 100'000, {}};
  const auto made = flood_basin(flood, kBasinEdge, everywhere);
  REQUIRE_FALSE(made.has_value());
  CHECK(made.error() == BasinFault::too_many_voxels);
  CHECK(asked < 2 * 100'000 / kBasinEdge);
  // One layer of a chunk's width with the limit exactly.
  const auto pit = [&](ChunkCoord at) {
    return at == ChunkCoord{0, 0, 0}
               ? air
               : std::make_shared<const RunChunk>(uniform_chunk(Extent::cube(kBasinEdge), kRock));
  };
  flood.level = 0;
  flood.voxels_max = kBasinEdge * kBasinEdge;
  const auto layer = flood_basin(flood, kBasinEdge, pit);
  REQUIRE(layer.has_value());
  CHECK(layer->voxels == flood.voxels_max);
  CHECK(layer->build->sides() == VoxelPos{kBasinEdge, 1, kBasinEdge});
  flood.voxels_max -= 1;
  CHECK_FALSE(flood_basin(flood, kBasinEdge, pit).has_value());
}

}  // namespace runstone::test
