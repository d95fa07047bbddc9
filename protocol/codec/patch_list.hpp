// Lists of patches of chunks, in VeiledCommit and VeilPatches. docs/protocol.md specifies the bytes.
// Internal to the message codec.
#pragma once
#include <cstdint>
#include <span>

#include "common/core/bytes.hpp"
#include "protocol/codec/key_list.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Appends patches without their number. `seq`: the sequence that the chunks get. Requires valid
/// patches that ascend by chunk and are not empty.
void put_patches(ByteWriter& out, std::span<const ChunkPatch> patches, Sequence seq);

/// Reads one patch. `edge`: the chunk edge, which `keys` has too. With `may_stay`, the chunk may have
/// the sequence `seq` before. Rejects what put_patches() would not write. Cost: O(bytes).
ChunkPatch take_patch(ByteReader& in, KeyReader& keys, Sequence seq, bool may_stay,
                      std::int32_t edge);

}  // namespace runstone
