#include <hwy/targets.h>

#include <catch2/catch.hpp>
#include <span>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/edit_stack_strategies.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

// Compares the layer painter with the dense oracle: at every chunk edge and axis order, with lines
// that fill vectors and lines that do not, on each instruction set, and with capsules whose numbers
// exceed the exact range of doubles.
namespace runstone::test {
namespace {

constexpr ApplyStrategy kPaint = {ChangeSearch::paint, PatchWrite::whole};
constexpr ApplyStrategy kSweep = {ChangeSearch::sweep, PatchWrite::whole};

void require_same(const RunChunk& start, VoxelPos origin, std::span<const EditDescriptor> edits,
                  ApplyScratch& scratch) {
  RunChunk painted = start, swept = start;
  Digest digest = digest_of(start);
  Digest digest_swept = digest;
  DenseChunk oracle = DenseChunk::of(start);
  const ApplyResult result = apply_stack_by(kPaint, painted, digest, origin, edits, scratch);
  const ApplyResult expected = apply_stack_by(kSweep, swept, digest_swept, origin, edits, scratch);
  const OracleOutcome outcome = oracle_apply(oracle, origin, edits);
  REQUIRE(validate(painted).has_value());
  REQUIRE(DenseChunk::of(painted) == oracle);
  REQUIRE(painted == swept);
  REQUIRE(result.voxels_changed == outcome.voxels_changed);
  REQUIRE(result.changed == expected.changed);
  REQUIRE(result.dirty == expected.dirty);
  REQUIRE(result.areas == expected.areas);
  REQUIRE(digest == digest_of(painted));
}

std::vector<EditDescriptor> stack_near(SplitMix64& rng, Extent extent, std::size_t depth) {
  std::vector<EditDescriptor> edits(depth);
  for (EditDescriptor& edit : edits) edit = random_edit_near(rng, {}, extent);
  return edits;
}

// Returns a stroke that passes through the chunk, of the given length and width.
EditDescriptor stroke_through(SplitMix64& rng, Extent extent, std::int32_t step,
                              std::int32_t radius) {
  const auto far = [&] { return rng.below(4) == 0 ? 0 : rng.between(-step, step); };
  std::array<std::int32_t, 3> d = {far(), far(), far()};
  if (d == std::array<std::int32_t, 3>{}) d[rng.below(3)] = step;
  // One radius away in some direction, so that the surface lies in the chunk.
  const auto from = [&](std::int32_t side, std::int32_t along) {
    const std::int32_t out =
        rng.below(3) == 0 ? (rng.below(2) == 0 ? -radius : radius) : rng.between(-4, 4);
    return side / 2 - along * rng.between(0, 8) / 8 + out;
  };
  const VoxelPos a{from(extent.x, d[0]), from(extent.y, d[1]), from(extent.z, d[2])};
  EditDescriptor edit;
  edit.shape =
      FillStroke{{a, {a.x + d[0], a.y + d[1], a.z + d[2]}}, static_cast<std::uint16_t>(radius)};
  edit.material = static_cast<Material>(rng.below(6));
  if (rng.below(2) == 0) edit.mask.kind = MaskKind::only_empty;
  return edit;
}

}  // namespace

TEST_CASE("painted stacks equal the dense oracle at every chunk edge and axis order",
          "[edits][property]") {
  SplitMix64 rng{41 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (const Extent extent : {Extent::cube(16), Extent::cube(32), Extent::cube(64),
                              Extent::cube(128), Extent{33, 9, 47}, Extent{31, 65, 8}}) {
    for (const AxisOrder order : kAxisOrders) {
      const RunChunk start = random_chunk(rng, extent, order, rng.below(4) == 0 ? 65536 : 6);
      const auto edits = stack_near(rng, extent, extent.volume() > 40'000 ? 4 : 1 + rng.below(80));
      CAPTURE(Catch::rngSeed(), extent.x, extent.y, extent.z, static_cast<int>(order), edits);
      require_same(start, {}, edits, scratch);
    }
  }
}

TEST_CASE("whole layers hide what lies below them only without a mask", "[edits][property]") {
  SplitMix64 rng{44 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (int round = 0; round < 60; ++round) {
    const Extent extent = Extent::cube(16);
    const RunChunk start = random_chunk(rng, extent, random_order(rng), 4);
    auto edits = stack_near(rng, extent, 20);
    for (int i = 0; i < 3; ++i) {
      EditDescriptor& edit = edits[rng.below(20)];
      edit.shape = FillBox{{{-1, -1, -1}, {16, 16, 16}}};
      edit.material = static_cast<Material>(rng.below(4));
    }
    CAPTURE(Catch::rngSeed(), round, edits, static_cast<int>(start.order));
    require_same(start, {}, edits, scratch);
  }
}

TEST_CASE("every instruction set paints the same", "[edits][property]") {
  ApplyScratch scratch;
  const auto targets = hwy::SupportedAndGeneratedTargets();
  REQUIRE(!targets.empty());
  for (const auto target : targets) {
    hwy::SetSupportedTargetsForTest(target);
    SplitMix64 rng{42 + Catch::rngSeed()};
    for (int round = 0; round < 40; ++round) {
      const RunChunk start = random_chunk(rng);
      const auto edits = stack_near(rng, start.extent, 1 + rng.below(40));
      CAPTURE(Catch::rngSeed(), hwy::TargetName(target), round, edits);
      require_same(start, {}, edits, scratch);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST_CASE("painted strokes equal the oracle from the shortest to the longest and widest",
          "[edits][property]") {
  SplitMix64 rng{43 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (int round = 0; round < 400; ++round) {
    const Extent extent = random_extent(rng, 40);
    const RunChunk start = random_chunk(rng, extent, random_order(rng), 4);
    const bool huge = rng.below(4) == 0;  // roots beyond 2^52
    std::vector<EditDescriptor> edits(1 + rng.below(6));
    for (EditDescriptor& edit : edits) {
      edit = stroke_through(rng, extent, huge ? kStrokeStepMax : rng.between(1, 60),
                            huge ? rng.between(300, 512) : rng.between(1, 9));
    }
    CAPTURE(Catch::rngSeed(), round, edits, extent.x, extent.y, extent.z,
            static_cast<int>(start.order));
    require_same(start, {}, edits, scratch);
  }
}

}  // namespace runstone::test
