#include "common/edits/apply/checked_edits.hpp"

#include <array>

namespace runstone {

Result<ApplyResult> try_apply_stack(RunChunk& chunk, Digest& digest, VoxelPos origin,
                                    std::span<const EditDescriptor> edits, ApplyScratch& scratch) {
  if (const auto valid = validate(chunk); !valid) return failure(valid.error());
  const std::array<std::int32_t, 3> first = {origin.x, origin.y, origin.z};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (first[axis] < -kWorldLimit || first[axis] > kWorldLimit - chunk.extent.sides()[axis])
      return fail(ErrorCode::bad_value, "chunk reaches out of the world");
  }
  for (std::size_t i = 0; i < edits.size(); ++i) {
    if (const auto valid = validate(edits[i]); !valid)
      return fail(valid.error().code, valid.error().what, i);
  }
  return apply_stack(chunk, digest, origin, edits, scratch);
}

}  // namespace runstone
