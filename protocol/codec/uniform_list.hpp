// The byte list of UniformChunks: chunks of one material each. Equal chunks in a row along z are
// one entry; an entry takes about six bytes. Internal to the message codec.
#pragma once
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Encodes the list. Requires 1 .. kUniformChunksMax chunks, strictly ascending by key and of one
/// level of detail.
Bytes encode_uniform(const std::vector<UniformChunk>& chunks);
/// Decodes the list. `edge` is that of the world's chunks and bounds their coordinates; `level` is
/// that of all chunks. The list is not canonical: equal chunks may be several entries.
Result<std::vector<UniformChunk>> decode_uniform(ByteView in, std::uint8_t level,
                                                 std::int32_t edge);

}  // namespace runstone
