#include "common/map/map_tops.hpp"

#include <catch2/catch.hpp>

#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using test::DenseChunk;

namespace {

constexpr std::int32_t kSide = 16;
constexpr Material kRock = 1, kPool = 2, kTurf = 3;

MapMaterials three_materials() {
  MaterialTable table;
  REQUIRE(table.add({"stone", {100, 100, 100, 255}, Visibility::opaque, {}}).has_value());
  REQUIRE(table.add({"water", {40, 80, 200, 128}, Visibility::transparent, {}}).has_value());
  REQUIRE(table.add({"grass", {60, 160, 60, 255}, Visibility::opaque, {}}).has_value());
  return map_materials(table);
}

RunChunk filled(Material material) { return uniform_chunk(Extent::cube(kSide), material); }

void put(RunChunk& chunk, std::uint8_t x, std::uint8_t y, std::uint8_t z, Material material) {
  fill(chunk, index_of({x, y, z}, chunk.extent, chunk.order), 1, material);
}

MapTops tops_of(const std::vector<StackedChunk>& chunks) {
  std::size_t work = 0;
  return find_map_tops(chunks, kSide, three_materials(), work);
}

/// The oracle: looks at the voxels of each column of the whole stack, from above.
MapTops dense_tops(const std::vector<StackedChunk>& chunks, const MapMaterials& materials) {
  std::vector<DenseChunk> dense;
  for (const StackedChunk& chunk : chunks) dense.push_back(DenseChunk::of(*chunk.voxels));
  MapTops out(kSide);
  out.ground.resize(out.surface.size());
  const auto find = [&](int x, int z, const ShowingMaterials& showing) {
    for (std::size_t i = 0; i < dense.size(); ++i) {
      for (int y = kSide - 1; y >= 0; --y) {
        const Material id = dense[i].at(x, y, z);
        if (id >= showing.size() || showing[id]) return ColumnTop{chunks[i].base_y + y, id};
      }
    }
    return ColumnTop{};
  };
  for (int z = 0; z < kSide; ++z) {
    for (int x = 0; x < kSide; ++x) {
      const auto at = static_cast<std::size_t>(x + kSide * z);
      out.surface[at] = find(x, z, materials.showing);
      out.ground[at] = find(x, z, materials.ground);
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the tops of random stacks of chunks are those of the dense oracle", "[map]") {
  SplitMix64 rng{Catch::rngSeed()};
  const MapMaterials materials = three_materials();
  for (int round = 0; round < 60; ++round) {
    std::vector<RunChunk> chunks;
    for (std::uint32_t i = 0; i <= rng.below(4); ++i) {
      const auto shape = static_cast<test::ChunkShape>(rng.next() % test::kShapeCount);
      chunks.push_back(
          test::random_chunk(rng, Extent::cube(kSide), test::random_order(rng), 5, shape));
    }
    std::vector<StackedChunk> stack;
    for (std::size_t i = 0; i < chunks.size(); ++i)
      stack.push_back({&chunks[i], 40 - static_cast<std::int32_t>(i) * 2 * kSide});
    CAPTURE(Catch::rngSeed(), round);
    const MapTops found = tops_of(stack), expected = dense_tops(stack, materials);
    REQUIRE(found.surface == expected.surface);
    const auto ground = found.ground_or_surface();
    REQUIRE(std::vector<ColumnTop>(ground.begin(), ground.end()) == expected.ground);
  }
}

TEST_CASE("tops have the surface and the ground below it, across chunks", "[map]") {
  RunChunk upper = filled(kEmpty), lower = filled(kRock);
  put(upper, 3, 4, 5, kPool);
  put(upper, 6, 0, 7, kTurf);
  const MapTops tops = tops_of({{&upper, 16}, {&lower, 0}});
  CHECK(tops.at(0, 0) == ColumnTop{15, kRock});
  CHECK(tops.at(3, 5) == ColumnTop{20, kPool});
  CHECK(tops.ground[3 + kSide * 5] == ColumnTop{15, kRock});
  CHECK(tops.at(6, 7) == ColumnTop{16, kTurf});
  CHECK(tops_of({{&upper, 16}}).at(1, 1) == ColumnTop{});
}

TEST_CASE("chunks below the ground are not visited", "[map]") {
  const RunChunk air = filled(kEmpty), stone = filled(kRock);
  const MapMaterials materials = three_materials();
  std::size_t two = 0, three = 0;
  static_cast<void>(
      find_map_tops(std::vector<StackedChunk>{{&air, 32}, {&stone, 16}}, kSide, materials, two));
  static_cast<void>(find_map_tops(std::vector<StackedChunk>{{&air, 32}, {&stone, 16}, {&stone, 0}},
                                  kSide, materials, three));
  CHECK(two == three);
  MapTopsFinder finder(kSide, materials);
  CHECK_FALSE(finder.is_complete());
  finder.visit({&stone, 16});
  CHECK(finder.is_complete());
}
