#include "common/edits/apply/stack_depths.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("depths of stacks are counted by powers of two", "[edits]") {
  StackDepths depths;
  CHECK(depths.text() == "none");
  for (const std::size_t depth : {0U, 1U, 1U, 2U, 3U, 4U, 5U, 8U, 9U, 2048U, 2049U, 1'000'000U})
    depths.add(depth);
  CHECK(depths.text() == "1:2 2:1 4:2 8:2 16:1 2048:1 2049+:2");
  StackDepths twice = depths;
  twice += depths;
  CHECK(twice.count(0) == 4);
  CHECK(twice.count(StackDepths::kBuckets - 1) == 4);
}
