#include "client/schedule/memory_budget.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <utility>
#include <vector>

#include "client/replica/replica.hpp"
#include "tests/support/codec/chunks_message.hpp"
#include "tests/support/runs/worst_chunk.hpp"

using namespace runstone;

namespace {

constexpr unsigned kWorstEdge = 16;

MemoryUse use_of(std::size_t bytes) { return {bytes, 0, 0, 0, 0}; }

std::int64_t squared_distance(ChunkCoord at) {
  return std::int64_t{at.x} * at.x + std::int64_t{at.y} * at.y + std::int64_t{at.z} * at.z;
}

/// A replica whose view a budget limits, and the messages of a hostile server.
struct BudgetBench {
  explicit BudgetBench(std::size_t bytes_max) : budget(bytes_max, {3, 1}) {
    replica.set_view(view);
    static_cast<void>(replica.open({kWorstEdge, 5, 77, 1, 0, 100, 0}));
  }
  /// Returns all chunks of the view that is wanted, the farthest first.
  static std::vector<ChunkCoord> wanted_chunks() {
    std::vector<ChunkCoord> out;
    const View wanted{1, {0, 0, 0}, 3, 1};
    for (std::int32_t x = -3; x <= 3; ++x) {
      for (std::int32_t y = -1; y <= 1; ++y) {
        for (std::int32_t z = -3; z <= 3; ++z) {
          if (wanted.contains({x, y, z})) out.push_back({x, y, z});
        }
      }
    }
    std::ranges::sort(out, std::ranges::greater{},
                      [](ChunkCoord at) { return std::pair(squared_distance(at), at); });
    return out;
  }
  void receive(ChunkCoord at, const Chunk& chunk) {
    replica.receive(test::chunks_of(ChunkSnapshot{{0, at}, chunk}, view.number), {});
    while (step(false)) {
    }
  }
  bool step(bool is_complete) {
    if (!budget.step(use_of(replica.chunk_bytes()), is_complete, now)) return false;
    ++view.number;
    view.radius_h = budget.radii().h;
    view.radius_v = budget.radii().v;
    replica.set_view(view);
    static_cast<void>(replica.drain_changes());
    return true;
  }
  MemoryBudget budget;
  View view{1, {0, 0, 0}, 3, 1};
  Replica replica;
  TimeUs now = 1'000'000'000;
};

}  // namespace

TEST_CASE("the view shrinks by steps in proportion, down to one chunk", "[client]") {
  MemoryBudget budget(100, {4, 2});
  CHECK_FALSE(budget.binds());
  std::vector<ViewRadii> radii;
  while (budget.step(use_of(101), true, 0)) radii.push_back(budget.radii());
  CHECK(radii == std::vector<ViewRadii>{{3, 2}, {2, 1}, {1, 1}, {0, 0}});
  CHECK(budget.binds());
  CHECK(budget.shrinks() == 4);
  CHECK(budget.peak_bytes() == 101);
  CHECK(budget.room(use_of(101)) == 0);
  CHECK(budget.room(use_of(40)) == 60);
}

TEST_CASE("the view grows when it is complete, after a pause, and if it should fit", "[client]") {
  MemoryBudget budget(1000, {2, 0});  // 13, 5 and 1 chunks
  CHECK(budget.step(use_of(1001), true, 0));
  const TimeUs later = MemoryBudget::kGrowPauseUs;
  CHECK_FALSE(budget.step(use_of(300), true, later - 1));
  CHECK_FALSE(budget.step(use_of(300), false, later));
  CHECK_FALSE(budget.step(use_of(400), true, later));  // 13 chunks like these need 1,040 bytes
  CHECK_FALSE(budget.step({300, 0, 0, 0, 300}, true, later));
  CHECK(budget.step({300, 0, 0, 0, 200}, true, later));  // no larger view has more textures
  CHECK(budget.radii() == ViewRadii{2, 0});
  CHECK_FALSE(budget.binds());
  CHECK(budget.growths() == 1);
}

TEST_CASE("a growth that fails doubles the pause before the next one", "[client]") {
  MemoryBudget budget(1000, {2, 0});
  TimeUs now = 0;
  static_cast<void>(budget.step(use_of(1001), true, now));
  for (TimeUs pause = MemoryBudget::kGrowPauseUs; pause < 100'000'000; pause *= 2) {
    CAPTURE(pause);
    now += pause;
    CHECK_FALSE(budget.step(use_of(10), true, now - 1));
    CHECK(budget.step(use_of(10), true, now));
    CHECK(budget.step(use_of(1001), true, now));
  }
}

TEST_CASE("other wanted radii replace the view, the same ones do not", "[client]") {
  MemoryBudget budget(1000, {2, 0});
  static_cast<void>(budget.step(use_of(1001), true, 0));
  budget.set_wanted({2, 0});
  CHECK(budget.radii() == ViewRadii{1, 0});
  budget.set_wanted({5, 3});
  CHECK(budget.radii() == ViewRadii{5, 3});
}

TEST_CASE("chunks of the worst case stay within the budget, and the nearest ones are kept",
          "[client]") {
  const std::size_t one =
      2 * sizeof(TrackedChunk) + test::worst_chunk(kWorstEdge).voxels.runs.byte_capacity();
  const std::size_t budget_bytes = 20 * one;
  BudgetBench bench(budget_bytes);
  const Chunk worst = test::worst_chunk(kWorstEdge, {1, 5});
  std::size_t most = 0;
  for (int round = 0; round < 2; ++round) {
    for (const ChunkCoord at : BudgetBench::wanted_chunks()) {
      bench.receive(at, worst);
      most = std::max(most, bench.replica.chunk_bytes());
    }
  }
  CHECK(most <= budget_bytes);
  CHECK(bench.budget.peak_bytes() <= budget_bytes + one);  // what arrived between two steps
  CHECK(bench.budget.binds());
  CHECK(bench.budget.shrinks() == 2);
  CHECK(bench.replica.confirmed_count() == 5);  // of 87
  for (const ChunkCoord at : BudgetBench::wanted_chunks()) {
    const ChunkPtr held = bench.replica.confirmed({0, at});
    REQUIRE((held != nullptr) == bench.view.contains(at));
    if (held) CHECK(held->voxels == worst.voxels);
  }
}

TEST_CASE("a chunk that was given up is requested again when there is room", "[client]") {
  BudgetBench bench(300'000);
  for (const ChunkCoord at : BudgetBench::wanted_chunks())
    bench.receive(at, test::worst_chunk(kWorstEdge, {1, 5}));
  REQUIRE(bench.budget.binds());
  const ChunkKey far{0, {3, 0, 0}};
  REQUIRE(bench.replica.confirmed(far) == nullptr);
  CHECK_FALSE(bench.replica.is_expected(far));
  Chunk cheap;
  cheap.voxels = uniform_chunk(Extent::cube(kWorstEdge), 1);
  cheap.version = {1, 6};
  cheap.digest = digest_of(cheap.voxels);
  for (const ChunkKey& key : bench.replica.confirmed_keys()) bench.receive(key.at, cheap);
  for (int i = 0; i < 3; ++i) {
    bench.now += MemoryBudget::kGrowPauseUs;
    static_cast<void>(bench.step(true));
  }
  CHECK_FALSE(bench.budget.binds());
  CHECK(bench.replica.is_expected(far));
  bench.receive(far.at, cheap);
  CHECK(bench.replica.confirmed(far) != nullptr);
}
