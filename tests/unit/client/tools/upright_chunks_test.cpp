#include "client/tools/upright_chunks.hpp"

#include <catch2/catch.hpp>

#include "common/core/hash.hpp"
#include "common/runs/reorder.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("chunks with lines along y are made once, and kept for one plan more", "[tools]") {
  SplitMix64 rng(3);
  const auto chunk = [&](AxisOrder order) {
    for (;;) {
      const RunChunk made = random_chunk(rng, Extent::cube(8), order, 4, ChunkShape::boxes);
      if (!made.is_uniform()) return std::make_shared<const RunChunk>(made);
    }
  };
  const auto a = chunk(AxisOrder::xyz), b = chunk(AxisOrder::zyx), c = chunk(AxisOrder::yxz);
  UprightChunks kept;
  kept.begin_plan();
  const auto upright = kept.of(a);
  CHECK(*upright == reorder(*a, AxisOrder::yxz));
  CHECK(kept.of(a) == upright);
  CHECK(kept.of(c) == c);
  CHECK(kept.size() == 1);
  kept.begin_plan();
  CHECK(kept.of(b) != upright);
  CHECK(kept.of(a) == upright);
  kept.begin_plan();
  CHECK(kept.of(a) == upright);
  kept.begin_plan();
  CHECK(kept.size() == 1);  // b was not read in the last plan
  kept.begin_plan();
  CHECK(kept.size() == 0);

  // The runs of both orders are bounded. A chunk without room is made each time.
  const auto runs_of = [](const RunChunk& made) {
    return made.runs.size() + reorder(made, AxisOrder::yxz).runs.size();
  };
  UprightChunks few(runs_of(*a) + runs_of(*b) - 1);
  few.begin_plan();
  const auto first = few.of(a);
  CHECK(*few.of(b) == reorder(*b, AxisOrder::yxz));
  CHECK(few.size() == 1);
  CHECK(few.of(a) == first);
  few.begin_plan();
  few.begin_plan();
  CHECK(few.size() == 0);
  CHECK(few.of(b) == few.of(b));
  few.clear();
  CHECK(few.size() == 0);
  CHECK(few.of(a) == few.of(a));
}

}  // namespace runstone::test
