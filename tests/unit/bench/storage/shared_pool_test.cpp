#include "bench/storage/shared_pool.hpp"

#include <array>
#include <catch2/catch.hpp>
#include <map>

using namespace runstone;
using bench::storage::SharedPool;

TEST_CASE("a shared pool keeps equal records once, until the last reference is removed",
          "[storage]") {
  using Record = std::array<std::uint32_t, 2>;
  SharedPool<Record> pool;
  std::map<Record, std::pair<std::uint32_t, std::uint32_t>> plain;  // slot and references
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 20'000; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const Record record = {rng.below(20), rng.below(20)};
    const auto known = plain.find(record);
    if (rng.below(5) < 3) {
      const auto [slot, added] = pool.add(record);
      REQUIRE(added == (known == plain.end()));
      auto& [at, references] = plain[record];
      if (!added) REQUIRE(slot == at);
      at = slot;
      ++references;
    } else if (known != plain.end()) {
      auto& [slot, references] = known->second;
      if (rng.below(4) == 0) {
        pool.share(slot);
        ++references;
      }
      REQUIRE(pool.release(slot) == (references == 1));
      if (--references == 0) plain.erase(known);
    }
    REQUIRE(pool.count() == plain.size());
    if (step % 100 == 0) {
      if (step % 500 == 0) pool.shrink_to_fit();
      for (const auto& [each, where] : plain) REQUIRE(pool[where.first] == each);
    }
  }
  for (const auto& [record, where] : plain) {
    for (std::uint32_t i = 0; i < where.second; ++i) pool.release(where.first);
  }
  CHECK(pool.count() == 0);
}
