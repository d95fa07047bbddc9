#include "common/edits/apply/replayed_chunk.hpp"

#include <catch2/catch.hpp>

#include "common/runs/reorder.hpp"
#include "tests/support/edits/edit_oracle.hpp"

namespace runstone::test {

TEST_CASE("a replayed chunk equals the chunk to which the edits were applied one by one",
          "[edits]") {
  SplitMix64 rng(20261122);
  const VoxelPos origin{-32, 0, 32};
  const Extent extent = Extent::cube(32);
  ReplayScratch scratch;
  ApplyScratch apply;
  for (int world = 0; world < 6; ++world) {
    Chunk start;
    start.voxels = uniform_chunk(extent, kEmpty);
    start.digest = digest_of(start.voxels);
    Chunk expected = start;
    ReplayedChunk replayed(start, origin);
    // The number of edits is no multiple of the stack's maximum, so that some edits are pending
    // when the log ends.
    const std::uint32_t edits = 2 * kReplayStackMax + 1 + rng.below(40);
    for (std::uint32_t seq = 1; seq <= edits; ++seq) {
      const EditDescriptor edit = random_edit_near(rng, origin, extent);
      apply_stack(expected.voxels, expected.digest, origin, {&edit, 1}, apply);
      replayed.add(edit, {3, seq}, scratch);
      CHECK(replayed.chunk().version == Version{3, seq});
    }
    CHECK(scratch.depths.count(6) == 2U * static_cast<unsigned>(world + 1));  // stacks of 33 to 64
    replayed.flush(scratch);
    CHECK(in_cheapest_order(replayed.chunk().voxels) == in_cheapest_order(expected.voxels));
    CHECK(replayed.chunk().digest == expected.digest);
  }
}

TEST_CASE("a replayed chunk reports once that its voxels changed", "[edits]") {
  Chunk start;
  start.voxels = uniform_chunk(Extent::cube(16), kEmpty);
  start.digest = digest_of(start.voxels);
  ReplayScratch scratch;
  ReplayedChunk replayed(start, {});
  replayed.add({SetVoxel{{1, 2, 3}}, {}, kEmpty}, {1, 1}, scratch);
  replayed.flush(scratch);
  CHECK_FALSE(replayed.take_changed());
  CHECK(scratch.voxels_changed == 0);
  replayed.add({SetVoxel{{1, 2, 3}}, {}, 5}, {1, 2}, scratch);
  replayed.flush(scratch);
  replayed.flush(scratch);
  CHECK(replayed.take_changed());
  CHECK_FALSE(replayed.take_changed());
  CHECK(scratch.voxels_changed == 1);
  CHECK(scratch.depths.text() == "1:2");
}

}  // namespace runstone::test
