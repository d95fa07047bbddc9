#include <catch2/catch.hpp>

#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/edit_stack_strategies.hpp"
#include "common/runs/run_builder.hpp"
#include "tests/support/edits/edit_oracle.hpp"

// The cases of figures 7.16 to 7.19 of the thesis, on a chunk of 8 x 8 x 8 in order xyz (a line is
// 8 voxels, a layer 64), and further cases with a stack. `A` .. `C` are materials, `_` is empty.
namespace runstone::test {
namespace {

constexpr Material _ = kEmpty;
constexpr Material A = 1;
constexpr Material B = 2;
constexpr Material C = 3;
const Extent kExtent = Extent::cube(8);
using Runs = std::vector<Run>;

RunChunk chunk_of_runs(const Runs& runs) {
  RunBuilder builder(kExtent, AxisOrder::xyz);
  for (const Run& run : runs) builder.append_to(run.end, run.material);
  return builder.finish();
}

Runs runs_of(const RunChunk& chunk) {
  Runs out;
  for (std::size_t i = 0; i < chunk.runs.size(); ++i) out.push_back(chunk.runs[i]);
  return out;
}

EditDescriptor at_index(VoxelIndex i, Material material, Mask mask = {}) {
  const LocalPos p = pos_of(i, kExtent, AxisOrder::xyz);
  return {SetVoxel{{p.x, p.y, p.z}}, mask, material};
}

EditDescriptor everywhere(Material material, Mask mask = {}) {
  return {FillBox{{{0, 0, 0}, {8, 8, 8}}}, mask, material};
}

struct Applied {
  Runs runs;
  ApplyResult result;
};

// Applies by every strategy that the stack allows and requires equal results.
Applied apply(const Runs& start, const std::vector<EditDescriptor>& edits) {
  ApplyScratch scratch;
  RunChunk chunk = chunk_of_runs(start);
  Digest digest = digest_of(chunk);
  const ApplyResult result = apply_stack(chunk, digest, {}, edits, scratch);
  REQUIRE(validate(chunk).has_value());
  REQUIRE(digest == digest_of(chunk));
  for (const ChangeSearch search : {ChangeSearch::walk, ChangeSearch::sweep}) {
    if (search == ChangeSearch::walk && edits.size() > 1) continue;
    for (const PatchWrite write : {PatchWrite::pieces, PatchWrite::whole}) {
      RunChunk other = chunk_of_runs(start);
      Digest other_digest = digest_of(other);
      const ApplyResult same =
          apply_stack_by({search, write}, other, other_digest, {}, edits, scratch);
      REQUIRE(other == chunk);
      REQUIRE(other_digest == digest);
      REQUIRE(same.areas == result.areas);
      REQUIRE(same.dirty == result.dirty);
      REQUIRE(same.voxels_changed == result.voxels_changed);
    }
  }
  return {runs_of(chunk), result};
}

using Areas = std::vector<EditArea>;

}  // namespace

TEST_CASE("figure 7.16: a change at the start of the first run splits it", "[edits]") {
  const auto [runs, result] = apply({{512, A}}, {at_index(0, B)});
  CHECK(runs == Runs{{1, B}, {512, A}});
  CHECK(result.areas == Areas{{0, 1, 2}});
  CHECK(result.voxels_changed == 1);
}

TEST_CASE("figure 7.17: a change at the start of a new run shortens it", "[edits]") {
  const auto [runs, result] = apply({{20, A}, {512, B}}, {at_index(20, C)});
  CHECK(runs == Runs{{20, A}, {21, C}, {512, B}});
  CHECK(result.areas == Areas{{1, 1, 2}});
}

TEST_CASE(
    "figure 7.17: a change at the start of a new run to the material before moves the boundary",
    "[edits]") {
  const auto [runs, result] = apply({{20, A}, {512, B}}, {at_index(20, A)});
  CHECK(runs == Runs{{21, A}, {512, B}});
  CHECK(result.areas == Areas{{0, 2, 2}});
}

TEST_CASE("figure 7.18: a change inside a run splits it into three", "[edits]") {
  const auto [runs, result] = apply({{5, _}, {512, A}}, {at_index(100, B)});
  CHECK(runs == Runs{{5, _}, {100, A}, {101, B}, {512, A}});
  CHECK(result.areas == Areas{{1, 1, 3}});
}

TEST_CASE("figure 7.19: a change at the start of a new line or layer lies in that line",
          "[edits]") {
  for (const VoxelIndex start : {8u, 64u, 128u + 8u}) {
    const auto [runs, result] = apply({{512, A}}, {at_index(start, B)});
    CHECK(runs == Runs{{start, A}, {start + 1, B}, {512, A}});
    CHECK(result.dirty.layer[0] == std::bitset<kSideMax>(1));
    CHECK(result.dirty.layer[1].test(start / 8 % 8));
    CHECK(result.dirty.layer[1].count() == 1);
    CHECK(result.dirty.layer[2].test(start / 64));
    CHECK(result.dirty.layer[2].count() == 1);
  }
}

TEST_CASE("a change of the last voxel ends the run list", "[edits]") {
  CHECK(apply({{512, A}}, {at_index(511, B)}).runs == Runs{{511, A}, {512, B}});
  CHECK(apply({{511, A}, {512, B}}, {at_index(511, A)}).runs == Runs{{512, A}});
}

TEST_CASE("a change that closes a gap merges with both neighbours", "[edits]") {
  const auto [runs, result] =
      apply({{10, B}, {30, A}, {31, _}, {60, A}, {512, B}}, {at_index(30, A)});
  CHECK(runs == Runs{{10, B}, {60, A}, {512, B}});
  CHECK(result.areas == Areas{{1, 3, 1}});
}

TEST_CASE("placing and picking the same voxel restores the runs", "[edits]") {
  const Runs start = {{100, A}, {512, _}};
  const auto placed = apply(start, {at_index(300, B)});
  CHECK(apply(placed.runs, {at_index(300, _)}).runs == start);
}

TEST_CASE("an edit to the material that is there changes nothing", "[edits]") {
  const auto [runs, result] = apply({{100, A}, {512, B}}, {at_index(5, A)});
  CHECK(runs == Runs{{100, A}, {512, B}});
  CHECK_FALSE(result.changed);
  CHECK_FALSE(result.dirty.any());
  CHECK(result.areas.empty());
  CHECK(result.voxels_changed == 0);
}

TEST_CASE("a stack whose edits cancel out changes nothing", "[edits]") {
  const Runs start = {{100, A}, {512, B}};
  const auto [runs, result] =
      apply(start, {at_index(5, C), everywhere(A, {MaskKind::only_material, C})});
  CHECK(runs == start);
  CHECK_FALSE(result.changed);
  CHECK(result.areas.empty());
}

TEST_CASE("an edit writes only voxels that its mask admits", "[edits]") {
  const Runs start = {{10, _}, {20, A}, {30, B}, {512, _}};
  CHECK(apply(start, {everywhere(C, {MaskKind::only_empty, 0})}).runs ==
        Runs{{10, C}, {20, A}, {30, B}, {512, C}});
  CHECK(apply(start, {everywhere(C, {MaskKind::only_solid, 0})}).runs ==
        Runs{{10, _}, {30, C}, {512, _}});
  CHECK(apply(start, {everywhere(B, {MaskKind::only_material, A})}).runs ==
        Runs{{10, _}, {30, B}, {512, _}});
  CHECK(apply(start, {everywhere(_, {MaskKind::only_material, B})}).runs ==
        Runs{{10, _}, {20, A}, {512, _}});
}

TEST_CASE("a mask tests the result of the edits below it", "[edits]") {
  const Mask empty = {MaskKind::only_empty, 0};
  CHECK(apply({{512, A}}, {everywhere(_), everywhere(B, empty), everywhere(C, empty)}).runs ==
        Runs{{512, B}});
  CHECK(apply({{512, A}}, {everywhere(B, empty), everywhere(_), everywhere(C, empty)}).runs ==
        Runs{{512, C}});
  CHECK(apply({{512, A}}, {everywhere(B, {MaskKind::only_material, A}),
                           everywhere(C, {MaskKind::only_material, B}), at_index(9, A)})
            .runs == Runs{{9, C}, {10, A}, {512, C}});
}

TEST_CASE("one fill of everything leaves one run and all layers dirty", "[edits]") {
  const auto [runs, result] = apply({{10, _}, {20, A}, {30, B}, {512, _}}, {everywhere(C)});
  CHECK(runs == Runs{{512, C}});
  CHECK(result.areas == Areas{{0, 4, 1}});
  CHECK(result.voxels_changed == 512);
  for (const auto& layers : result.dirty.layer) CHECK(layers == std::bitset<kSideMax>(0xff));
}

TEST_CASE("areas count their first run in the new list and join when no kept run lies between",
          "[edits]") {
  const auto apart = apply({{512, A}}, {at_index(10, B), at_index(12, B)});
  CHECK(apart.result.areas == Areas{{0, 1, 5}});
  const auto two = apply({{20, A}, {40, B}, {60, A}, {512, _}}, {at_index(5, C), at_index(50, C)});
  CHECK(two.result.areas == Areas{{0, 1, 3}, {4, 1, 3}});
}

TEST_CASE("dirty layers of a stretch that wraps around a line are those of its two ends",
          "[edits]") {
  // Voxels 6 .. 9: the end of line 0 and the start of line 1. The walk meets them as one stretch of
  // a run if the geometry covers both lines completely and the other voxels have the material
  // already.
  const auto [runs, result] = apply({{6, B}, {10, A}, {512, B}}, {everywhere(B)});
  CHECK(runs == Runs{{512, B}});
  CHECK(result.dirty.layer[0] == std::bitset<kSideMax>(0b11000011));
  CHECK(result.dirty.layer[1] == std::bitset<kSideMax>(0b11));
  CHECK(result.dirty.layer[2] == std::bitset<kSideMax>(1));
}

TEST_CASE("dirty lines of a stretch that wraps around a layer are those of its two ends",
          "[edits]") {
  const auto [runs, result] = apply({{48, B}, {72, A}, {512, B}}, {everywhere(B)});
  CHECK(runs == Runs{{512, B}});
  CHECK(result.dirty.layer[0] == std::bitset<kSideMax>(0xff));
  CHECK(result.dirty.layer[1] == std::bitset<kSideMax>(0b11000001));
  CHECK(result.dirty.layer[2] == std::bitset<kSideMax>(0b11));
}

TEST_CASE("edits that miss the chunk do nothing, bounding box or not", "[edits]") {
  const Runs start = {{100, A}, {512, B}};
  const EditDescriptor far_voxel = {SetVoxel{{8, 0, 0}}, {}, C};
  // The box of this sphere overlaps the chunk's corner, the sphere does not.
  const EditDescriptor past_corner = {FillSphere{{-4, -4, -4}, 4}, {}, C};
  REQUIRE(bounding_box(past_corner).contains({0, 0, 0}));
  CHECK(apply(start, {far_voxel}).runs == start);
  CHECK(apply(start, {past_corner}).runs == start);
  CHECK_FALSE(apply(start, {far_voxel, past_corner, past_corner}).result.changed);
  CHECK(apply(start, {far_voxel, at_index(0, C)}).runs == Runs{{1, C}, {100, A}, {512, B}});
  CHECK(apply(start, {}).runs == start);
}

TEST_CASE("a chunk at a world position takes edits in world coordinates", "[edits]") {
  ApplyScratch scratch;
  RunChunk chunk = uniform_chunk(Extent::cube(16), _, AxisOrder::zyx);
  Digest digest = digest_of(chunk);
  const EditDescriptor edit = {FillSphere{{-17, 40, 5}, 3}, {}, A};
  apply_stack(chunk, digest, {-32, 32, 0}, std::span(&edit, 1), scratch);
  CHECK(material_at(chunk, {15, 8, 5}) == A);
  CHECK(material_at(chunk, {12, 8, 5}) == A);
  CHECK(material_at(chunk, {11, 8, 5}) == _);
  CHECK(digest == digest_of(chunk));
}

TEST_CASE("a box with a mask replaces a material in the box", "[edits]") {
  // Replacing needs no kind of its own: A becomes B inside the box and nowhere else. C and empty
  // voxels stay.
  const EditDescriptor replace = {FillBox{{{2, 0, 0}, {6, 1, 1}}}, {MaskKind::only_material, A}, B};
  CHECK(apply({{3, A}, {4, C}, {5, _}, {8, A}, {512, _}}, {replace}).runs ==
        Runs{{2, A}, {3, B}, {4, C}, {5, _}, {6, B}, {8, A}, {512, _}});
}

TEST_CASE("a stroke meets the mask once, also where its segments overlap", "[edits]") {
  // Along the line and back: A becomes B, and B is not changed again.
  const FillStroke there_and_back{{{-2, 0, 0}, {9, 0, 0}, {-2, 0, 0}}, 1};
  const Runs start = {{8, A}, {512, _}};
  const Applied swapped = apply(start, {{there_and_back, {MaskKind::only_material, A}, B}});
  CHECK(swapped.runs == Runs{{8, B}, {512, _}});
  CHECK(swapped.result.voxels_changed == 8);
  // The edit fills the empty voxels: the two lines and the layer next to the first one.
  const Applied filled = apply(start, {{there_and_back, {MaskKind::only_empty, _}, C}});
  CHECK(filled.runs == Runs{{8, A}, {16, C}, {64, _}, {80, C}, {512, _}});
}

TEST_CASE("a reused result forgets the previous call", "[edits]") {
  ApplyScratch scratch;
  ApplyResult result;
  RunChunk chunk = chunk_of_runs({{512, A}});
  Digest digest = digest_of(chunk);
  const EditDescriptor edit = at_index(77, B);
  apply_stack(chunk, digest, {}, std::span(&edit, 1), scratch, result);
  REQUIRE(result.changed);
  apply_stack(chunk, digest, {}, std::span(&edit, 1), scratch, result);
  CHECK_FALSE(result.changed);
  CHECK_FALSE(result.dirty.any());
  CHECK(result.areas.empty());
  CHECK(result.voxels_changed == 0);
}

}  // namespace runstone::test
