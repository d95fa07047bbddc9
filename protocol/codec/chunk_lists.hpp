// The byte lists of CachedChunks, ChunksNotModified and ChunkEdits. Keys are differences and
// numbers are varints, so a claim and its answer take about 20 bytes together. docs/protocol.md
// specifies the layout. Decoding accepts only canonical lists within the limits.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

// The encoders require at least one entry, strictly ascending keys or sequences, and counts within
// the limits.

Bytes encode_cached_chunks(std::span<const CachedChunk> chunks);
Bytes encode_unmodified(std::span<const UnmodifiedChunk> chunks);
/// `from` is a sequence below those of all edits.
Bytes encode_missing_edits(std::span<const MissingEdit> edits, Sequence from);

// `edge` is that of the world's chunks, or the largest one. The decoders reject keys outside the
// world.

Result<std::vector<CachedChunk>> decode_cached_chunks(ByteView bytes, std::int32_t edge);
Result<std::vector<UnmodifiedChunk>> decode_unmodified(ByteView bytes, std::int32_t edge);
Result<std::vector<MissingEdit>> decode_missing_edits(ByteView bytes, Sequence from);

/// Returns how many of the first chunks fit one CachedChunks message. Requires at least one chunk.
std::size_t cached_chunks_that_fit(std::span<const CachedChunk> chunks);

}  // namespace runstone
