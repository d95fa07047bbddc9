#include <catch2/catch.hpp>

#include "common/edits/apply/edit_stack.hpp"
#include "tests/support/core/count_allocations.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("applying stacks allocates nothing once scratch, result and chunk have their size",
          "[edits]") {
  SplitMix64 rng{31};
  ApplyScratch scratch;
  ApplyResult result;
  const RunChunk start =
      random_chunk(rng, Extent::cube(32), AxisOrder::yxz, 5, ChunkShape::columns);
  std::vector<EditDescriptor> edits(100);
  for (EditDescriptor& edit : edits) {
    do {
      edit = random_edit_near(rng, {}, start.extent);
    } while (std::holds_alternative<Paste>(edit.shape));  // a paste allocates
  }
  const auto all = [&](RunChunk& chunk) {
    Digest digest = digest_of(chunk);
    apply_stack(chunk, digest, {}, edits, scratch, result);
    for (const EditDescriptor& edit : edits) {
      apply_stack(chunk, digest, {}, std::span(&edit, 1), scratch, result);
    }
  };
  RunChunk warm = start;
  warm.runs.reserve(start.volume());
  RunChunk measured = warm;
  measured.runs.reserve(start.volume());
  all(warm);
  REQUIRE(allocations().count > 0);
  CHECK(allocations_of([&] { all(measured); }).count == 0);
  CHECK(measured == warm);
}

TEST_CASE("a scratch used on other chunks before gives the same result as a fresh one", "[edits]") {
  SplitMix64 rng{32};
  ApplyScratch used;
  for (int round = 0; round < 200; ++round) {
    RunChunk chunk = random_chunk(rng);
    RunChunk same = chunk;
    std::vector<EditDescriptor> edits(1 + rng.below(10));
    for (EditDescriptor& edit : edits) edit = random_edit_near(rng, {}, chunk.extent);
    Digest digest = digest_of(chunk);
    Digest same_digest = digest;
    ApplyScratch fresh;
    apply_stack(chunk, digest, {}, edits, used);
    apply_stack(same, same_digest, {}, edits, fresh);
    REQUIRE(chunk == same);
    REQUIRE(digest == same_digest);
  }
}

}  // namespace runstone::test
