// The byte lists of CachedChunks, ChunksNotModified and DigestCheck. Keys are differences and
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

// The encoders require at least one entry, strictly ascending keys of one level of detail, and
// counts within the limits. Digest checks have level 0.

Bytes encode_cached_chunks(std::span<const CachedChunk> chunks);
Bytes encode_unmodified(std::span<const UnmodifiedChunk> chunks);
Bytes encode_digest_checks(std::span<const DigestCheckEntry> entries);

// `edge` is that of the world's chunks, or the largest one; `level` is the level of detail of all
// keys. The decoders reject keys outside the world.

Result<std::vector<CachedChunk>> decode_cached_chunks(ByteView bytes, std::uint8_t level,
                                                      std::int32_t edge);
Result<std::vector<UnmodifiedChunk>> decode_unmodified(ByteView bytes, std::uint8_t level,
                                                       std::int32_t edge);
Result<std::vector<DigestCheckEntry>> decode_digest_checks(ByteView bytes, std::int32_t edge);

/// Returns how many of the first chunks fit one CachedChunks message: those of the first one's
/// level of detail, within the limits. Requires at least one chunk.
std::size_t cached_chunks_that_fit(std::span<const CachedChunk> chunks);

}  // namespace runstone
