// Every store of the benchmark is compared with plain voxels: when it is made, after sets and balls
// at random places, and by its size.
#include <catch2/catch.hpp>
#include <cmath>
#include <map>

#include "bench/storage/flat_array.hpp"
#include "bench/storage/interval_map.hpp"
#include "bench/storage/morton_array.hpp"
#include "bench/storage/palette_store.hpp"
#include "bench/storage/run_store.hpp"
#include "bench/storage/voxel_tree.hpp"
#include "common/core/hash.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

using namespace runstone;
using namespace runstone::bench::storage;
using test::DenseChunk;

namespace {

#define RUNSTONE_STORES                                                                     \
  FlatArray, MortonArray<MortonByTable>, MortonArray<MortonByPdep>, PaletteStore, RunStore, \
      IntervalMap, SparseOctree, VoxelDag

template <class Store>
constexpr bool runs_here() {
  return true;
}
template <>
bool runs_here<MortonArray<MortonByPdep>>() {
  return morton_by_pdep();
}

LocalPos random_place(SplitMix64& rng, unsigned edge) {
  const auto along = [&] { return static_cast<std::uint8_t>(rng.below(edge)); };
  const std::uint8_t x = along(), y = along();
  return {x, y, along()};
}

RunChunk random_cube(SplitMix64& rng, unsigned edge, unsigned materials) {
  return test::random_chunk(rng, Extent::cube(edge), test::random_order(rng), materials);
}

/// Sets the voxels nearer than the radius plus half a voxel, one by one.
void paint(DenseChunk& oracle, LocalPos centre, int radius, Material material) {
  for (int z = 0; z < oracle.side_z(); ++z) {
    for (int y = 0; y < oracle.side_y(); ++y) {
      for (int x = 0; x < oracle.side_x(); ++x) {
        if (std::hypot(x - centre.x, y - centre.y, z - centre.z) < radius + 0.5) {
          oracle.set(x, y, z, material);
        }
      }
    }
  }
}

/// Returns the first voxel that differs, or nullopt.
template <class Store>
std::optional<VoxelPos> first_difference(const Store& store, const DenseChunk& oracle) {
  for (int z = 0; z < oracle.side_z(); ++z) {
    for (int y = 0; y < oracle.side_y(); ++y) {
      for (int x = 0; x < oracle.side_x(); ++x) {
        const LocalPos at = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y),
                             static_cast<std::uint8_t>(z)};
        if (store.at(at) != oracle.at(x, y, z)) return VoxelPos{x, y, z};
      }
    }
  }
  return std::nullopt;
}

using Tally = std::map<Material, std::uint32_t>;

template <class Store>
Tally walked(const Store& store) {
  Tally out;
  store.walk([&](std::uint32_t count, Material material) { out[material] += count; });
  return out;
}

Tally counted(const DenseChunk& oracle) {
  Tally out;
  for (int z = 0; z < oracle.side_z(); ++z) {
    for (int y = 0; y < oracle.side_y(); ++y) {
      for (int x = 0; x < oracle.side_x(); ++x) ++out[oracle.at(x, y, z)];
    }
  }
  return out;
}

RunChunk runs_of(const DenseChunk& oracle, AxisOrder order) {
  RunBuilder builder(oracle.extent(), order);
  for (std::uint32_t i = 0; i < oracle.extent().volume(); ++i) {
    const VoxelPos at = test::dense_pos(oracle.extent(), order, i);
    builder.append(1, oracle.at(at.x, at.y, at.z));
  }
  return builder.finish();
}

/// Returns what must be equal in an edited store and one made from its voxels: the parts that
/// stores keep collapsed. Arrays have none, and palettes do not shrink.
std::vector<std::size_t> canonical(const RunStore& store) {
  REQUIRE(validate(store.chunk()));
  return {store.chunk().runs.size()};
}
std::vector<std::size_t> canonical(const IntervalMap& store) { return {store.byte_size()}; }
template <template <class> class Pool>
std::vector<std::size_t> canonical(const VoxelTree<Pool>& store) {
  return {store.node_counts()[0], store.node_counts()[1]};
}
std::vector<std::size_t> canonical(const FlatArray&) { return {}; }
std::vector<std::size_t> canonical(const PaletteStore&) { return {}; }
template <class Code>
std::vector<std::size_t> canonical(const MortonArray<Code>&) {
  return {};
}

}  // namespace

TEMPLATE_TEST_CASE("a store stays equal to plain voxels through random sets and balls",
                   "[storage][property]", RUNSTONE_STORES) {
  if (!runs_here<TestType>()) return;
  SplitMix64 rng{Catch::rngSeed()};
  for (int round = 0; round < 40; ++round) {
    const unsigned edge = round % 8 == 7 ? 32 : 8u << rng.below(2);
    const unsigned materials = round % 5 == 4 ? 2000 : 1 + rng.below(6);
    const RunChunk chunk = random_cube(rng, edge, materials);
    TestType store(chunk);
    DenseChunk oracle = DenseChunk::of(chunk);
    CAPTURE(Catch::rngSeed(), round, edge, materials);
    REQUIRE(first_difference(store, oracle) == std::nullopt);
    REQUIRE(walked(store) == counted(oracle));
    for (int step = 0; step < 60; ++step) {
      CAPTURE(step);
      const LocalPos at = random_place(rng, edge);
      // Mostly a material of the neighbourhood, so that parts collapse and runs merge again.
      const LocalPos near = random_place(rng, edge);
      const Material material = rng.below(3) == 0 ? static_cast<Material>(rng.below(materials + 1))
                                                  : oracle.at(near.x, near.y, near.z);
      if (rng.below(4) == 0) {
        const int radius = static_cast<int>(rng.below(Ball::kRadiusMax + 1));
        store.paint(Ball(at, radius), material);
        paint(oracle, at, radius, material);
      } else {
        store.set(at, material);
        oracle.set(at.x, at.y, at.z, material);
      }
      if (step % 6 == 0 || step == 59) {
        REQUIRE(first_difference(store, oracle) == std::nullopt);
        REQUIRE(walked(store) == counted(oracle));
        REQUIRE(canonical(store) == canonical(TestType(runs_of(oracle, chunk.order))));
      }
    }
  }
}

TEMPLATE_TEST_CASE("a store that became one material again is as small as one that always was",
                   "[storage]", RUNSTONE_STORES) {
  if (!runs_here<TestType>()) return;
  SplitMix64 rng{Catch::rngSeed()};
  TestType store(random_cube(rng, 16, 5));
  for (const std::uint8_t corner : {std::uint8_t{0}, std::uint8_t{15}}) {
    for (const std::uint8_t x : {std::uint8_t{0}, std::uint8_t{15}}) {
      for (const std::uint8_t z : {std::uint8_t{0}, std::uint8_t{15}}) {
        store.paint(Ball({x, corner, z}, Ball::kRadiusMax), 9);
      }
    }
  }
  store.paint(Ball({8, 8, 8}, Ball::kRadiusMax), 9);
  CHECK(walked(store) == Tally{{9, 16 * 16 * 16}});
  CHECK(canonical(store) == canonical(TestType(uniform_chunk(Extent::cube(16), 9))));
}

TEMPLATE_TEST_CASE("copies of a store do not change with it", "[storage]", RUNSTONE_STORES) {
  if (!runs_here<TestType>()) return;
  SplitMix64 rng{Catch::rngSeed()};
  const RunChunk chunk = random_cube(rng, 16, 5);
  const DenseChunk before = DenseChunk::of(chunk);
  const TestType store(chunk);
  TestType copy = store;
  copy.paint(Ball({8, 8, 8}, 5), 77);
  copy.set({0, 0, 0}, 78);
  CHECK(copy.at({8, 8, 8}) == 77);
  CHECK(first_difference(store, before) == std::nullopt);
}
