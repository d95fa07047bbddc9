// The target decodes any bytes as chunk bytes. A chunk that decodes must be valid and come back
// from all encodings. Raw and coded bytes have one spelling.
#include <cstdint>

#include "common/core/assert.hpp"
#include "protocol/chunks/chunk_codec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace runstone;
  const ByteView in(data, size);
  const auto chunk = decode_chunk(in);
  if (!chunk) return 0;
  RUNSTONE_ASSERT(validate(*chunk).has_value());
  const Bytes raw = encode_chunk(*chunk, ChunkEncoding::raw);
  RUNSTONE_ASSERT(raw.size() == raw_bytes(*chunk));
  if (in[0] == static_cast<std::uint8_t>(ChunkEncoding::raw))
    RUNSTONE_ASSERT(raw == Bytes(in.begin(), in.end()));
  const auto from_raw = decode_chunk(raw, chunk->extent);
  RUNSTONE_ASSERT(from_raw && *from_raw == *chunk);
  const Bytes coded = encode_chunk(*chunk, ChunkEncoding::coded);
  if (in[0] == static_cast<std::uint8_t>(ChunkEncoding::coded))
    RUNSTONE_ASSERT(coded == Bytes(in.begin(), in.end()));
  const auto from_coded = decode_chunk(coded, chunk->extent);
  RUNSTONE_ASSERT(from_coded && *from_coded == *chunk);
  const auto from_packed = decode_chunk(encode_chunk(*chunk, ChunkEncoding::packed), chunk->extent);
  RUNSTONE_ASSERT(from_packed && *from_packed == *chunk);
  return 0;
}
