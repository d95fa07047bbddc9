// The canonical bytes of a VeilPatch in the axis order kVeilOrder:
//   varint   number of spans
//   for each span:
//     varint   voxels between the end of the span before and its first voxel; of the first span:
//              its first voxel
//     varint   2 * (voxels - 1), plus 1 if the material is that of the span before
//     varint   the material, if it is not
// A voxel that one dug voxel uncovers takes 2 to 7 bytes.
#pragma once
#include "common/core/bytes.hpp"
#include "common/veil/veil_patch.hpp"

namespace runstone {

/// Appends the bytes of a patch. Requires a valid patch in the order kVeilOrder.
void write_patch_bytes(const VeilPatch& patch, ByteWriter& out);

/// Reads a patch of a chunk of this extent. The result passes validate(). Fails with the fault and
/// its byte offset if the bytes end early, if bytes are left over, or if write_patch_bytes() would
/// write other bytes for this patch. The materials are not checked. Memory and cost: O(bytes).
Result<VeilPatch> read_patch_bytes(ByteView bytes, Extent extent);

}  // namespace runstone
