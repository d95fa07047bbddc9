// The target reads bytes as a chunk and a script of edit stacks, and applies them to runs and to
// the dense oracle side by side.
//   chunk:  side x, y, z (8 + byte % 17), axis order, shape, seed (u16)
//   stack:  depth (1 + byte % 8), then per edit: kind, mask, mask material, material, x, y, z,
//           three sizes; from kind 192 on a paste in orientation (kind - 192) % 48, then the
//           seed (u16) of its clipboard
// Missing bytes at the end read as zeros.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/core/assert.hpp"
#include "common/edits/apply/edit_stack.hpp"
#include "common/edits/apply/edit_stack_strategies.hpp"
#include "tests/support/edits/edit_oracle.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kScriptBytesMax = 600;  // bounds the time of one input

EditDescriptor read_edit(ByteReader& in) {
  EditDescriptor edit;
  const std::uint8_t kind = in.u8();
  edit.mask.kind = static_cast<MaskKind>(in.u8() % 4);
  const auto mask_material = static_cast<Material>(in.u8() % 4);
  if (edit.mask.kind == MaskKind::only_material) edit.mask.material = mask_material;
  edit.material = static_cast<Material>(in.u8() % 4);
  const auto coordinate = [&in] { return static_cast<std::int32_t>(in.u8() % 40) - 8; };
  VoxelPos at;
  at.x = coordinate();
  at.y = coordinate();
  at.z = coordinate();
  const std::int32_t x = in.u8() % 40;
  const std::int32_t y = in.u8() % 40;
  const std::int32_t z = in.u8() % 40;
  if (kind >= 192) {
    SplitMix64 rng{in.u16()};
    edit.shape =
        Paste{at, random_clipboard(rng, 1 + static_cast<unsigned>(x), 4),
              *Orientation::of_byte(static_cast<std::uint8_t>(kind - 192) % kOrientationCount)};
    edit.material = kEmpty;
    return edit;
  }
  if (kind % 4 == 0) edit.shape = SetVoxel{at};
  if (kind % 4 == 1) edit.shape = FillBox{{at, {at.x + 1 + x, at.y + 1 + y, at.z + 1 + z}}};
  if (kind % 4 == 2) edit.shape = FillSphere{at, static_cast<std::uint16_t>(x)};
  if (kind % 4 == 3) {
    FillStroke stroke{{at}, static_cast<std::uint16_t>(1 + kind / 4 % 4)};
    for (const VoxelPos step :
         {VoxelPos{x - 20, y - 20, z - 20}, VoxelPos{20 - y, x / 2 - 10, z / 4}}) {
      const VoxelPos& last = stroke.points.back();
      if (step != VoxelPos{})
        stroke.points.push_back({last.x + step.x, last.y + step.y, last.z + step.z});
    }
    edit.shape = stroke.points.size() > 1 ? EditShape{stroke} : EditShape{SetVoxel{at}};
  }
  return edit;
}

void run_script(ByteReader& in) {
  Extent extent;
  extent.x = static_cast<std::uint8_t>(8 + in.u8() % 17);
  extent.y = static_cast<std::uint8_t>(8 + in.u8() % 17);
  extent.z = static_cast<std::uint8_t>(8 + in.u8() % 17);
  const AxisOrder order = kAxisOrders[in.u8() % kAxisOrderCount];
  const auto shape = static_cast<ChunkShape>(in.u8() % kShapeCount);
  SplitMix64 rng{in.u16()};
  RunChunk chunk = random_chunk(rng, extent, order, 4, shape);
  DenseChunk oracle = DenseChunk::of(chunk);
  Digest digest = digest_of(chunk);
  ApplyScratch scratch;
  while (in.ok() && !in.at_end()) {
    std::vector<EditDescriptor> edits(1 + in.u8() % 8);
    for (EditDescriptor& edit : edits) edit = read_edit(in);
    RunChunk swept = chunk;
    Digest swept_digest = digest;
    const ApplyStrategy strategy = {ChangeSearch::sweep, PatchWrite::whole};
    const ApplyResult result = apply_stack(chunk, digest, {}, edits, scratch);
    const ApplyResult same = apply_stack_by(strategy, swept, swept_digest, {}, edits, scratch);
    const OracleOutcome expected = oracle_apply(oracle, {}, edits);
    RUNSTONE_ASSERT(validate(chunk).has_value());
    RUNSTONE_ASSERT(result.voxels_changed == expected.voxels_changed);
    RUNSTONE_ASSERT(result.changed == (expected.voxels_changed != 0));
    RUNSTONE_ASSERT(DenseChunk::of(chunk) == oracle);
    RUNSTONE_ASSERT(digest == digest_of(chunk));
    RUNSTONE_ASSERT(swept == chunk && swept_digest == digest);
    RUNSTONE_ASSERT(same.areas == result.areas && same.dirty == result.dirty);
  }
}

}  // namespace
}  // namespace runstone::test

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  ByteReader in(ByteView(data, std::min(size, test::kScriptBytesMax)));
  test::run_script(in);
  return 0;
}
