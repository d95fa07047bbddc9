// The bytes that a store reports are those that it takes from the heap: a copy takes exactly as
// many.
#include <catch2/catch.hpp>

#include "bench/storage/flat_array.hpp"
#include "bench/storage/heap_bytes.hpp"
#include "bench/storage/interval_map.hpp"
#include "bench/storage/morton_array.hpp"
#include "bench/storage/palette_store.hpp"
#include "bench/storage/run_store.hpp"
#include "bench/storage/voxel_tree.hpp"
#include "tests/support/core/count_allocations.hpp"
#include "tests/support/runs/random_chunk.hpp"

#if defined(__GLIBC__)
#include <malloc.h>
#endif

using namespace runstone;
using namespace runstone::bench::storage;

TEMPLATE_TEST_CASE("a store counts all that it keeps, and keeps nothing to spare", "[storage]",
                   FlatArray, MortonArray<MortonByTable>, PaletteStore, RunStore, IntervalMap,
                   SparseOctree, VoxelDag) {
  SplitMix64 rng{Catch::rngSeed()};
  for (const unsigned edge : {8u, 16u, 32u, 64u}) {
    for (const unsigned materials : {1u, 3u, 40u, 2000u}) {
      CAPTURE(Catch::rngSeed(), edge, materials);
      const TestType store(
          test::random_chunk(rng, Extent::cube(edge), test::random_order(rng), materials));
      std::size_t copy_bytes = 0;
      const test::Allocations taken = test::allocations_of([&] {
        const TestType copy = store;
        copy_bytes = copy.byte_size();
      });
      // Each block takes 8 bytes more than requested, rounded up to a step of 16 and to 32.
      const std::size_t heap = store.byte_size() - sizeof store;
      CHECK(heap >= taken.bytes + 8 * taken.count);
      CHECK(heap <= taken.bytes + 31 * taken.count);
      CHECK(copy_bytes == store.byte_size());
    }
  }
}

TEST_CASE("an interval is a node of 40 bytes in a block of 48", "[storage]") {
  const auto intervals = [](Material second) {
    RunStore store(uniform_chunk(Extent::cube(8), 1));
    store.set({7, 7, 7}, second);
    return IntervalMap(store.chunk());
  };
  CHECK(intervals(2).byte_size() - intervals(1).byte_size() == 48);
  const IntervalMap two = intervals(2);
  CHECK(test::allocations_of([&] { const IntervalMap copy = two; }).bytes == 80);
}

#if defined(__GLIBC__) && !defined(RUNSTONE_SANITIZED)
TEST_CASE("heap_bytes() agrees with malloc", "[storage]") {
  CHECK(heap_bytes(0) == 0);
  for (std::size_t bytes = 1; bytes < 100'000; bytes += bytes < 200 ? 1 : 997) {
    CAPTURE(bytes);
    void* const block = std::malloc(bytes);
    // malloc adds a rest that is too small for a block.
    const std::size_t taken = malloc_usable_size(block) + 8;
    CHECK((taken == heap_bytes(bytes) || taken == heap_bytes(bytes) + 16));
    std::free(block);
  }
}
#endif
