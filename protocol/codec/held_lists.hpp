// The byte lists of held, same and chunk_edits: keys as differences, numbers as varints, so that a claim and its answer
// cost some 20 bytes together. docs/protocol.md has the layout. What is read is bounded by the limits and canonical.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// The three require what their messages demand: at least one entry, strictly ascending keys (sequences), counts within
/// the limits.
Bytes encode_held(std::span<const HeldChunk> chunks);
Bytes encode_same(std::span<const SameChunk> chunks);
/// `from`: the sequence that all edits lie behind.
Bytes encode_missing(std::span<const MissingEdit> edits, Sequence from);

/// `edge`: of the world's chunks, or the largest; keys outside of the world are refused.
Result<std::vector<HeldChunk>> decode_held(ByteView bytes, std::int32_t edge);
Result<std::vector<SameChunk>> decode_same(ByteView bytes, std::int32_t edge);
Result<std::vector<MissingEdit>> decode_missing(ByteView bytes, Sequence from);

/// How many of the first chunks go into one held message. Requires at least one chunk.
std::size_t held_that_fit(std::span<const HeldChunk> chunks);

}  // namespace runstone
