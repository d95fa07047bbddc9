#include "client/build/cut_edit.hpp"

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <vector>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

EditLimits limits_of(std::int32_t edge, std::uint64_t volume_max = 1'000'000) {
  EditLimits limits;
  limits.chunk_edge = edge;
  limits.material_count = 100;
  limits.heights = {-200, 300};
  limits.volume_max = volume_max;
  return limits;
}

std::vector<EditDescriptor> all_of(EditSource& source) {
  std::vector<EditDescriptor> out;
  for (;;) {
    SourceStep step = source.next();
    if (step.kind == SourceStep::Kind::end) return out;
    REQUIRE(step.kind == SourceStep::Kind::edit);
    REQUIRE(out.size() < 100'000);
    out.push_back(std::move(step.edit));
  }
}

std::uint64_t volume(const VoxelBox& box) { return counted_voxels({FillBox{box}, {}, 1}); }

}  // namespace

TEST_CASE("a large box is cut into legal boxes of whole chunks that cover it once",
          "[client][build]") {
  const std::int32_t edge = GENERATE(16, 32, 64, 128);
  const std::uint64_t volume_max = GENERATE(as<std::uint64_t>{}, 5'000, 60'000, 1'000'000);
  CAPTURE(edge, volume_max);
  const EditLimits limits = limits_of(edge, volume_max);
  const VoxelBox box{{-77, -33, 5}, {130, 90, 201}};
  REQUIRE(needs_cut({FillBox{box}, {}, 1}, limits));
  const auto source = cut_box(box, {}, 7, limits);
  CHECK(source->voxels() == volume(box));
  const auto pieces = all_of(*source);
  std::uint64_t sum = 0;
  std::map<ChunkCoord, int> touches_of;
  for (const EditDescriptor& piece : pieces) {
    CHECK_FALSE(check_edit(piece, limits).has_value());
    CHECK(piece.material == 7);
    const VoxelBox& part = std::get<FillBox>(piece.shape).box;
    CHECK(intersect(part, box) == part);
    sum += volume(part);
    for (const ChunkCoord at : touched_chunks(piece, edge)) ++touches_of[at];
  }
  CHECK(sum == volume(box));
  for (std::size_t i = 0; i < pieces.size() && pieces.size() < 600; ++i) {
    for (std::size_t j = i + 1; j < pieces.size(); ++j)
      REQUIRE(
          intersect(std::get<FillBox>(pieces[i].shape).box, std::get<FillBox>(pieces[j].shape).box)
              .empty());
  }
  const auto chunk_side = static_cast<std::uint64_t>(edge);
  const bool has_whole_chunks = volume_max >= chunk_side * chunk_side * chunk_side;
  for (const auto& [at, count] : touches_of) {
    if (has_whole_chunks) CHECK(count == 1);
  }
}

TEST_CASE("512 voxels a side are few pieces, and a box beyond the heights is cut to them",
          "[client][build]") {
  const EditLimits limits = limits_of(32);
  const auto pieces = all_of(*cut_box({{0, -200, 0}, {512, 300, 512}}, {}, 1, limits));
  CHECK(pieces.size() <= 260);
  const auto high = cut_box({{0, 250, 0}, {64, 5'000, 64}}, {}, 1, limits);
  CHECK(high->voxels() == 64 * 64 * 50);
  for (const EditDescriptor& piece : all_of(*high)) CHECK_FALSE(check_edit(piece, limits));
  CHECK(all_of(*cut_box({{0, 300, 0}, {64, 400, 64}}, {}, 1, limits)).empty());
  CHECK(needs_cut({FillBox{{{0, 0, 0}, {9'000, 1, 1}}}, {}, 1}, limits));
}

TEST_CASE("an edit that needs no cut is its own piece", "[client][build]") {
  const EditLimits limits = limits_of(32);
  const EditDescriptor edit{FillSphere{{3, 4, 5}, 9}, {MaskKind::only_empty, kEmpty}, 4};
  REQUIRE_FALSE(needs_cut(edit, limits));
  CHECK(all_of(*cut_edit(edit, limits)) == std::vector<EditDescriptor>{edit});
}

TEST_CASE("the pieces of any shape have the effect of the whole", "[client][build][property]") {
  SplitMix64 rng{3 + Catch::rngSeed()};
  const EditLimits limits = limits_of(16, 600);
  std::size_t cut = 0;
  for (int round = 0; round < 20; ++round) {
    CAPTURE(Catch::rngSeed(), round);
    EditDescriptor edit = random_edit_near(rng, {0, 0, 0}, Extent::cube(32));
    if (round % 3 == 0) edit = {FillSphere{{15, 16, 14}, 13}, edit.mask, edit.material};
    if (!needs_cut(edit, limits)) continue;
    ++cut;
    const auto pieces = all_of(*cut_edit(edit, limits));
    for (const EditDescriptor& piece : pieces) {
      CHECK_FALSE(check_edit(piece, limits).has_value());
      CHECK(touched_chunks(piece, 16).size() == 1);
    }
    const RunChunk start = random_chunk(rng, Extent::cube(32), AxisOrder::xyz, 4);
    DenseChunk whole = DenseChunk::of(start), parts = whole;
    const std::vector<EditDescriptor> one = {edit};
    oracle_apply(whole, {0, 0, 0}, one);
    oracle_apply(parts, {0, 0, 0}, pieces);
    CHECK(whole == parts);
  }
  CHECK(cut > 5);
}

}  // namespace runstone::test
