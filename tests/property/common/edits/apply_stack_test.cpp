#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <string>

#include "common/edits/apply/edit_changes.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/edit_stack_strategies.hpp"
#include "common/runs/reorder.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr ApplyStrategy kSweepWhole = {ChangeSearch::sweep, PatchWrite::whole};
constexpr ApplyStrategy kSweepPieces = {ChangeSearch::sweep, PatchWrite::pieces};
constexpr ApplyStrategy kPaintWhole = {ChangeSearch::paint, PatchWrite::whole};
constexpr ApplyStrategy kPaintPieces = {ChangeSearch::paint, PatchWrite::pieces};
constexpr ApplyStrategy kWalkWhole = {ChangeSearch::walk, PatchWrite::whole};
constexpr ApplyStrategy kWalkPieces = {ChangeSearch::walk, PatchWrite::pieces};

// Returns a place for the chunk: near the origin, on its grid or not, or at a corner of the world.
VoxelPos random_origin(SplitMix64& rng, Extent extent) {
  switch (rng.below(4)) {
    case 0:
      return {0, 0, 0};
    case 1:
      return {-static_cast<std::int32_t>(extent.x), extent.y,
              -2 * static_cast<std::int32_t>(extent.z)};
    case 2:
      return {rng.between(-1000, 1000), rng.between(-1000, 1000), rng.between(-1000, 1000)};
    default:  // 128 away from the corner, so that edits near the chunk stay inside the world
      return {kWorldLimit - 256, -kWorldLimit + 128, kWorldLimit - 256};
  }
}

std::vector<EditDescriptor> random_stack(SplitMix64& rng, VoxelPos origin, Extent extent,
                                         std::size_t depth) {
  std::vector<EditDescriptor> edits(depth);
  for (EditDescriptor& edit : edits) edit = random_edit_near(rng, origin, extent);
  return edits;
}

std::array<std::set<unsigned>, 3> listed(const DirtyLayers& dirty) {
  std::array<std::set<unsigned>, 3> out;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (unsigned i = 0; i < kSideMax; ++i) {
      if (dirty.layer[axis].test(i)) out[axis].insert(i);
    }
  }
  return out;
}

std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> listed(
    const std::vector<EditArea>& areas) {
  std::vector<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> out;
  for (const EditArea& area : areas) out.emplace_back(area.first, area.before, area.after);
  return out;
}

bool same(const ApplyResult& a, const ApplyResult& b) {
  return a.changed == b.changed && a.dirty == b.dirty && a.areas == b.areas &&
         a.voxels_changed == b.voxels_changed;
}

/// Applies the edits to the runs and to the oracle. Returns the first difference, or null if there
/// is none.
const char* difference(RunChunk& chunk, Digest& digest, DenseChunk& oracle, VoxelPos origin,
                       std::span<const EditDescriptor> edits, ApplyScratch& scratch,
                       OracleFault fault = OracleFault::none) {
  const RunChunk before = chunk;
  const ApplyResult result = apply_stack(chunk, digest, origin, edits, scratch);
  const std::span<const Change> made = changes_of(scratch, result);
  const std::vector<Change> changes(made.begin(), made.end());
  if (!std::ranges::equal(find_changes(before, origin, edits, scratch), changes)) return "changes";
  const OracleOutcome expected = oracle_apply(oracle, origin, edits, fault);
  if (!validate(chunk)) return "invariants";
  if (!(DenseChunk::of(chunk) == oracle)) return "voxels";
  if (result.changed != (expected.voxels_changed != 0)) return "changed";
  if (result.voxels_changed != expected.voxels_changed) return "voxels_changed";
  if (listed(result.dirty) != expected.dirty) return "dirty";
  if (listed(result.areas) != oracle_areas(before, chunk)) return "areas";
  if (digest != digest_of(chunk)) return "digest";
  return nullptr;
}

}  // namespace

TEST_CASE("stacks of edits equal the dense oracle in voxels, digest and report",
          "[edits][property]") {
  SplitMix64 rng{1 + Catch::rngSeed()};
  ApplyScratch scratch;
  std::size_t edits_done = 0;
  std::size_t stacks_changed = 0;
  while (edits_done < 12'000) {
    RunChunk chunk = random_chunk(rng);
    const VoxelPos origin = random_origin(rng, chunk.extent);
    Digest digest = digest_of(chunk);
    DenseChunk oracle = DenseChunk::of(chunk);
    for (int step = 0; step < 6; ++step) {
      const std::size_t depth = rng.below(2) == 0 ? 1 : 1 + rng.below(40);
      const auto edits = random_stack(rng, origin, chunk.extent, depth);
      CAPTURE(Catch::rngSeed(), edits_done, step, edits, chunk.extent.x, chunk.extent.y,
              chunk.extent.z, static_cast<int>(chunk.order));
      const RunChunk before = chunk;
      const char* differs = difference(chunk, digest, oracle, origin, edits, scratch);
      INFO((differs == nullptr ? "" : differs));
      REQUIRE(differs == nullptr);
      edits_done += depth;
      stacks_changed += chunk == before ? 0 : 1;
    }
    REQUIRE(digest == oracle.digest());
  }
  CHECK(stacks_changed > 300);
}

TEST_CASE("a stack equals its edits one after another, by every strategy", "[edits][property]") {
  SplitMix64 rng{2 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (int round = 0; round < 400; ++round) {
    const RunChunk start = random_chunk(rng);
    const VoxelPos origin = random_origin(rng, start.extent);
    const auto edits = random_stack(rng, origin, start.extent, 1 + rng.below(40));
    CAPTURE(Catch::rngSeed(), round, edits);
    RunChunk one_by_one = start;
    Digest digest_one_by_one = digest_of(start);
    for (const EditDescriptor& edit : edits) {
      RunChunk first = one_by_one;
      Digest first_digest = digest_one_by_one;
      const std::span<const EditDescriptor> single(&edit, 1);
      const ApplyResult result =
          apply_stack_by(kWalkPieces, first, first_digest, origin, single, scratch);
      for (const ApplyStrategy strategy : {kWalkWhole, kSweepPieces, kSweepWhole, kPaintWhole}) {
        RunChunk other = one_by_one;
        Digest other_digest = digest_one_by_one;
        REQUIRE(
            same(apply_stack_by(strategy, other, other_digest, origin, single, scratch), result));
        REQUIRE(other == first);
        REQUIRE(other_digest == first_digest);
      }
      one_by_one = first;
      digest_one_by_one = first_digest;
    }
    RunChunk chosen = start;
    Digest chosen_digest = digest_of(start);
    const ApplyResult result = apply_stack(chosen, chosen_digest, origin, edits, scratch);
    REQUIRE(chosen == one_by_one);
    REQUIRE(chosen_digest == digest_one_by_one);
    for (const ApplyStrategy strategy : {kSweepPieces, kSweepWhole, kPaintPieces, kPaintWhole}) {
      RunChunk other = start;
      Digest other_digest = digest_of(start);
      REQUIRE(same(apply_stack_by(strategy, other, other_digest, origin, edits, scratch), result));
      REQUIRE(other == one_by_one);
      REQUIRE(other_digest == digest_one_by_one);
    }
  }
}

TEST_CASE("a stack deeper than a word of the active set equals its edits one after another",
          "[edits][property]") {
  SplitMix64 rng{3 + Catch::rngSeed()};
  ApplyScratch scratch;
  for (const Extent extent :
       {Extent::cube(32), Extent::cube(16), Extent{128, 9, 20}, Extent{64, 64, 64}}) {
    for (const AxisOrder order : kAxisOrders) {
      RunChunk stacked = random_chunk(rng, extent, order, 6);
      const auto edits = random_stack(rng, {}, extent, 300);
      RunChunk one_by_one = stacked;
      Digest digest = digest_of(stacked);
      Digest digest_one_by_one = digest;
      apply_stack(stacked, digest, {}, edits, scratch);
      for (const EditDescriptor& edit : edits) {
        apply_stack(one_by_one, digest_one_by_one, {}, std::span(&edit, 1), scratch);
      }
      REQUIRE(stacked == one_by_one);
      REQUIRE(digest == digest_one_by_one);
    }
  }
}

TEST_CASE("a paste follows its orientation in each axis order of clipboard and chunk",
          "[edits][property]") {
  SplitMix64 rng{6 + Catch::rngSeed()};
  ApplyScratch scratch;
  constexpr Extent kChunk{9, 11, 13};
  for (std::uint8_t byte = 0; byte < kOrientationCount; ++byte) {
    for (const AxisOrder order : kAxisOrders) {
      for (const AxisOrder cells_order : kAxisOrders) {
        const auto some = random_clipboard(rng, 16, 6);
        const auto clipboard = *Clipboard::of(some->palette(), reorder(some->cells(), cells_order));
        const auto at = [&] { return rng.between(-6, 9); };
        Mask mask{static_cast<MaskKind>(rng.below(4)), kEmpty};
        if (mask.kind == MaskKind::only_material)
          mask.material = static_cast<Material>(rng.below(4));
        const EditDescriptor edit{Paste{{at(), at(), at()}, clipboard, *Orientation::of_byte(byte)},
                                  mask, kEmpty};
        RunChunk chunk = random_chunk(rng, kChunk, order, 4);
        Digest digest = digest_of(chunk);
        DenseChunk oracle = DenseChunk::of(chunk);
        CAPTURE(Catch::rngSeed(), edit, static_cast<int>(order));
        const char* differs = difference(chunk, digest, oracle, {}, std::span(&edit, 1), scratch);
        INFO((differs == nullptr ? "" : differs));
        REQUIRE(differs == nullptr);
      }
    }
  }
}

TEST_CASE("an edit that reaches over many chunks changes each as the oracle says",
          "[edits][property]") {
  SplitMix64 rng{4 + Catch::rngSeed()};
  ApplyScratch scratch;
  constexpr std::int32_t kEdge = 16;
  for (int round = 0; round < 30; ++round) {
    const EditDescriptor edit = random_edit_near(rng, {-20, -20, -20}, Extent::cube(40));
    CAPTURE(Catch::rngSeed(), round, edit);
    std::uint64_t voxels = 0;
    for (const ChunkCoord c : touched_chunks(edit, kEdge)) {
      RunChunk chunk = random_chunk(rng, Extent::cube(kEdge), random_order(rng), 4);
      DenseChunk oracle = DenseChunk::of(chunk);
      Digest digest = digest_of(chunk);
      const VoxelPos origin = origin_of(c, kEdge);
      voxels += apply_stack(chunk, digest, origin, std::span(&edit, 1), scratch).voxels_changed;
      oracle_apply(oracle, origin, std::span(&edit, 1));
      REQUIRE(DenseChunk::of(chunk) == oracle);
    }
    REQUIRE(voxels <= counted_voxels(edit));
  }
}

TEST_CASE("a broken edit oracle is caught", "[edits][property]") {
  // The same random stacks with oracles that are wrong on purpose, each in its own way.
  const auto caught_by = [](OracleFault fault) {
    SplitMix64 rng{5};
    ApplyScratch scratch;
    std::map<std::string, int> caught;
    for (int round = 0; round < 120; ++round) {
      RunChunk chunk = random_chunk(rng);
      const VoxelPos origin = random_origin(rng, chunk.extent);
      Digest digest = digest_of(chunk);
      DenseChunk oracle = DenseChunk::of(chunk);
      const auto edits = random_stack(rng, origin, chunk.extent, 1 + rng.below(40));
      const char* differs = difference(chunk, digest, oracle, origin, edits, scratch, fault);
      if (differs != nullptr) ++caught[differs];
    }
    return caught;
  };
  CHECK(caught_by(OracleFault::none).empty());
  CHECK(caught_by(OracleFault::thin_sphere)["voxels"] > 20);
  CHECK(caught_by(OracleFault::thin_stroke)["voxels"] > 20);
  CHECK(caught_by(OracleFault::unturned_paste)["voxels"] > 20);
  CHECK(caught_by(OracleFault::early_mask)["voxels"] > 20);
  CHECK(caught_by(OracleFault::lost_voxel)["voxels"] > 60);
  CHECK(caught_by(OracleFault::miscounted_voxel)["voxels_changed"] > 60);
}

}  // namespace runstone::test
