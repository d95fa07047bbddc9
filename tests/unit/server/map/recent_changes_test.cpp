#include "server/map/recent_changes.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("the answer has each column that changed since, with its newest edit", "[map]") {
  RecentChanges changes;
  changes.begin(10);
  changes.add(11, std::vector<ChunkCoord>{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}});
  changes.add(12, std::vector<ChunkCoord>{{0, 0, 0}});
  const auto all = changes.after(10);
  CHECK(all.is_complete);
  CHECK(all.columns == std::vector<ChangedColumn>{{0, 0, 12}, {1, 0, 11}});
  CHECK(changes.after(11).columns == std::vector<ChangedColumn>{{0, 0, 12}});
  CHECK(changes.after(12).is_complete);
  CHECK(changes.after(12).columns.empty());
  CHECK(changes.after(kSequenceMax).columns.empty());
  CHECK_FALSE(changes.after(9).is_complete);
}

TEST_CASE("more changes than are kept make the answer incomplete, never wrong", "[map]") {
  RecentChanges changes;
  changes.begin(0);
  std::vector<ChunkCoord> wide;
  for (std::int32_t x = 0; x < 2'000; ++x) wide.push_back({x, 0, 0});
  changes.add(1, wide);
  CHECK_FALSE(changes.after(0).is_complete);  // too many for an answer
  CHECK(changes.after(1).is_complete);
  for (Sequence seq = 2; seq < 12; ++seq) changes.add(seq, wide);
  changes.add(12, std::vector<ChunkCoord>{{5, 0, 5}});
  CHECK_FALSE(changes.after(1).is_complete);  // no longer kept
  CHECK(changes.after(11).columns == std::vector<ChangedColumn>{{5, 5, 12}});
  std::vector<ChunkCoord> huge;
  for (std::int32_t x = 0; x < 20'000; ++x) huge.push_back({x, 0, 0});
  changes.add(13, huge);
  CHECK_FALSE(changes.after(12).is_complete);
  CHECK(changes.after(13).is_complete);
}
