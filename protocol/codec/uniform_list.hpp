// Uniform list: many chunks of one material each, as the bytes of a uniform_chunks message. Chunks that lie on top of
// each other and are alike are one entry; an entry costs some six bytes. Internal to the message codec.
#pragma once
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Requires 1 .. kUniformChunksMax chunks of lod 0, ascending by is_before_in_list().
Bytes encode_uniform(const std::vector<UniformChunk>& chunks);
/// `edge`: of the world's chunks, which bounds their coordinates. Not canonical: entries could be longer.
Result<std::vector<UniformChunk>> decode_uniform(ByteView in, std::int32_t edge);

}  // namespace runstone
