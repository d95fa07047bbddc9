// The hidden case prints what chunks and coarse tiles of generated worlds cost. docs/worlds.md has
// the figures.
#include <array>
#include <catch2/catch.hpp>
#include <cstdio>
#include <string>

#include "common/core/tile_keys.hpp"
#include "common/generate/generator.hpp"
#include "common/generate/spawn_point.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/runs/reorder.hpp"

using namespace runstone;

namespace {

constexpr std::int32_t kCostEdge = 32;
constexpr std::int32_t kCostReach = 6, kCostReachUp = 4;  // chunks around the spawn

void print_chunks(const std::string& name, std::uint64_t seed, const Generator& generator) {
  const ChunkCoord middle = chunk_of(spawn_point(generator, landscape_material_table()), kCostEdge);
  double all_ns = 0, chunks = 0, mixed = 0, runs = 0, mixed_runs = 0;
  for (std::int32_t x = -kCostReach; x <= kCostReach; ++x) {
    for (std::int32_t z = -kCostReach; z <= kCostReach; ++z) {
      for (std::int32_t y = -kCostReachUp; y <= kCostReachUp; ++y) {
        const VoxelPos origin = origin_of({middle.x + x, middle.y + y, middle.z + z}, kCostEdge);
        const auto start = thread_cpu_ns();
        const RunChunk chunk = generator.generate(origin, Extent::cube(kCostEdge));
        all_ns += static_cast<double>(thread_cpu_ns() - start);
        const auto count = static_cast<double>(in_cheapest_order(chunk).runs.size());
        ++chunks;
        runs += count;
        if (chunk.is_uniform()) continue;
        ++mixed;
        mixed_runs += count;
      }
    }
  }
  std::printf(
      "%s, seed %llu: %.0f us a chunk, %.0f a mixed one; %.0f runs a chunk, %.0f a mixed one\n",
      name.c_str(), static_cast<unsigned long long>(seed), all_ns / chunks / 1e3,
      all_ns / mixed / 1e3, runs / chunks, mixed_runs / mixed);
}

void print_tiles(const std::string& name, const Generator& generator) {
  for (std::uint8_t level = 3; level <= 6; ++level) {
    double all_ns = 0, tiles = 0;
    for (std::int32_t x = -4; x < 4; ++x) {
      for (std::int32_t z = -4; z < 4; ++z) {
        const auto start = thread_cpu_ns();
        const auto tile =
            generator.coarse(tile_origin({level, {x, 0, z}}, kCostEdge), kCostEdge, level);
        all_ns += static_cast<double>(thread_cpu_ns() - start);
        REQUIRE(tile.has_value());
        ++tiles;
      }
    }
    std::printf("%s, level %d: %.0f us a tile\n", name.c_str(), int{level}, all_ns / tiles / 1e3);
  }
}

}  // namespace

TEST_CASE("the cost of chunks of generated worlds", "[.cost]") {
  for (const std::uint64_t seed : std::array<std::uint64_t, 4>{1, 2, 3, 7}) {
    for (const char* name : {"terrain", "landscape"}) {
      const auto made = make_generator({name, 1, seed, ""}, landscape_material_table());
      REQUIRE(made.has_value());
      print_chunks(name, seed, **made);
      if (seed == 7) print_tiles(name, **made);
    }
  }
}
