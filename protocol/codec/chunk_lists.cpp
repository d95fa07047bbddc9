#include "protocol/codec/chunk_lists.hpp"

#include <algorithm>

#include "protocol/codec/key_list.hpp"

namespace runstone {
namespace {

constexpr std::size_t kMessageOverheadMax = 64;  // of the FlatBuffers around the list

void put_cached_chunk(ByteWriter& out, KeyWriter& keys, const CachedChunk& chunk) {
  keys.put(out, chunk.key);
  put_version(out, chunk.version);
  out.u64(chunk.digest);
}

}  // namespace

Bytes encode_cached_chunks(std::span<const CachedChunk> chunks) {
  RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= kCachedChunksMax);
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter keys(chunks.front().key.lod);
  for (const CachedChunk& chunk : chunks) put_cached_chunk(out, keys, chunk);
  return bytes;
}

std::size_t cached_chunks_that_fit(std::span<const CachedChunk> chunks) {
  RUNSTONE_ASSERT(!chunks.empty());
  Bytes bytes;
  ByteWriter out(bytes);
  const std::uint8_t level = chunks.front().key.lod;
  KeyWriter keys(level);
  std::size_t count = 0;
  for (const CachedChunk& chunk : chunks.first(std::min(chunks.size(), kCachedChunksMax))) {
    if (chunk.key.lod != level) break;
    put_cached_chunk(out, keys, chunk);
    if (bytes.size() > kClientControlBytesMax - kMessageOverheadMax) break;
    ++count;
  }
  return count;
}

Bytes encode_unmodified(std::span<const UnmodifiedChunk> chunks) {
  RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= kChunksNotModifiedMax);
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter keys(chunks.front().key.lod);
  Sequence last = 0;
  for (const UnmodifiedChunk& chunk : chunks) {
    keys.put(out, chunk.key);
    out.svarint(static_cast<std::int64_t>(chunk.seq) - static_cast<std::int64_t>(last));
    last = chunk.seq;
  }
  return bytes;
}

Bytes encode_digest_checks(std::span<const DigestCheckEntry> entries) {
  RUNSTONE_ASSERT(!entries.empty() && entries.size() <= kDigestCheckEntriesMax);
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter keys;
  for (const DigestCheckEntry& entry : entries) {
    keys.put(out, entry.key);
    put_version(out, entry.version);
    put_digest(out, entry.digest);
  }
  return bytes;
}

Result<std::vector<CachedChunk>> decode_cached_chunks(ByteView bytes, std::uint8_t level,
                                                      std::int32_t edge) {
  KeyReader keys(edge, level);
  return entries_of<CachedChunk>(bytes, kCachedChunksMax, [&keys](ByteReader& in) {
    CachedChunk chunk;
    chunk.key = keys.take(in);
    chunk.version = take_version(in);
    chunk.digest = take_lane(in);
    return chunk;
  });
}

Result<std::vector<UnmodifiedChunk>> decode_unmodified(ByteView bytes, std::uint8_t level,
                                                       std::int32_t edge) {
  KeyReader keys(edge, level);
  std::int64_t last = 0;
  return entries_of<UnmodifiedChunk>(bytes, kChunksNotModifiedMax, [&](ByteReader& in) {
    UnmodifiedChunk chunk;
    chunk.key = keys.take(in);
    const auto most = static_cast<std::int64_t>(kSequenceMax) - last;
    last += in.svarint_in(-last, most, "sequence is out of range");
    chunk.seq = static_cast<Sequence>(last);
    return chunk;
  });
}

Result<std::vector<DigestCheckEntry>> decode_digest_checks(ByteView bytes, std::int32_t edge) {
  KeyReader keys(edge);
  return entries_of<DigestCheckEntry>(bytes, kDigestCheckEntriesMax, [&keys](ByteReader& in) {
    DigestCheckEntry entry;
    entry.key = keys.take(in);
    entry.version = take_version(in);
    entry.digest = take_digest(in);
    return entry;
  });
}

}  // namespace runstone
