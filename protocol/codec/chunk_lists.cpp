#include "protocol/codec/chunk_lists.hpp"

#include <algorithm>

#include "common/core/m61.hpp"

namespace runstone {
namespace {

constexpr std::size_t kMessageOverheadMax = 128;  // of the FlatBuffers around the list

/// Writes keys, each as its difference to the one before, the first to (0, 0, 0).
class KeyWriter {
 public:
  void put(ByteWriter& out, const ChunkKey& key) {
    RUNSTONE_ASSERT(key.lod == 0 && (is_first_ || last_ < key.at));
    is_first_ = false;
    out.svarint(std::int64_t{key.at.x} - last_.x);
    out.svarint(std::int64_t{key.at.y} - last_.y);
    out.svarint(std::int64_t{key.at.z} - last_.z);
    last_ = key.at;
  }

 private:
  ChunkCoord last_;
  bool is_first_ = true;
};

class KeyReader {
 public:
  explicit KeyReader(std::int32_t edge) : reach_(kWorldLimit / edge) {}
  ChunkKey take(ByteReader& in) {
    ChunkCoord at;
    at.x = next(in, last_.x);
    at.y = next(in, last_.y);
    at.z = next(in, last_.z);
    if (!is_first_ && in.ok() && at <= last_)
      in.reject(ErrorCode::not_canonical, "chunk keys do not ascend");
    is_first_ = false;
    last_ = at;
    return {0, at};
  }

 private:
  std::int32_t next(ByteReader& in, std::int32_t before) const {
    const std::int64_t low = -std::int64_t{reach_} - before;
    const std::int64_t high = std::int64_t{reach_} - 1 - before;
    return static_cast<std::int32_t>(before +
                                     in.svarint_in(low, high, "chunk key is outside the world"));
  }
  std::int32_t reach_;
  ChunkCoord last_;
  bool is_first_ = true;
};

void put_cached_chunk(ByteWriter& out, KeyWriter& keys, const CachedChunk& chunk) {
  keys.put(out, chunk.key);
  out.varint(chunk.version.epoch);
  if (chunk.version.epoch != 0) out.varint(chunk.version.seq);
  out.u64(chunk.digest);
}

/// Calls `take` for each entry until the bytes end. Requires at least one entry; fails if there are
/// more than `count_max`.
template <class Entry, class Take>
Result<std::vector<Entry>> entries_of(ByteView bytes, std::size_t count_max, Take&& take) {
  std::vector<Entry> out;
  ByteReader in(bytes);
  do {
    if (out.size() == count_max) in.reject(ErrorCode::limit_exceeded, "list has too many entries");
    Entry entry = take(in);
    if (!in.ok()) return Unexpected<Error>{in.error()};
    out.push_back(std::move(entry));
  } while (!in.at_end());
  return out;
}

}  // namespace

Bytes encode_cached_chunks(std::span<const CachedChunk> chunks) {
  RUNSTONE_ASSERT(!chunks.empty() && chunks.size() <= kCachedChunksMax);
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter keys;
  for (const CachedChunk& chunk : chunks) put_cached_chunk(out, keys, chunk);
  return bytes;
}

std::size_t cached_chunks_that_fit(std::span<const CachedChunk> chunks) {
  RUNSTONE_ASSERT(!chunks.empty());
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter keys;
  std::size_t count = 0;
  for (const CachedChunk& chunk : chunks.first(std::min(chunks.size(), kCachedChunksMax))) {
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
  KeyWriter keys;
  Sequence last = 0;
  for (const UnmodifiedChunk& chunk : chunks) {
    keys.put(out, chunk.key);
    out.svarint(static_cast<std::int64_t>(chunk.seq) - static_cast<std::int64_t>(last));
    last = chunk.seq;
  }
  return bytes;
}

Bytes encode_missing_edits(std::span<const MissingEdit> edits, Sequence from) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const MissingEdit& missing : edits) {
    RUNSTONE_ASSERT(missing.seq > from);
    const Bytes edit = encode(missing.edit);
    out.varint(missing.seq - from);
    out.varint(edit.size());
    out.bytes(edit);
    from = missing.seq;
  }
  return bytes;
}

Result<std::vector<CachedChunk>> decode_cached_chunks(ByteView bytes, std::int32_t edge) {
  KeyReader keys(edge);
  return entries_of<CachedChunk>(bytes, kCachedChunksMax, [&keys](ByteReader& in) {
    CachedChunk chunk;
    chunk.key = keys.take(in);
    chunk.version.epoch = static_cast<Epoch>(in.varint_max(0xffff'ffff, "epoch exceeds 32 bits"));
    if (chunk.version.epoch != 0)
      chunk.version.seq = in.varint_max(kSequenceMax, "sequence exceeds 63 bits");
    if (chunk.version.epoch != 0 && chunk.version.seq == 0) {
      in.reject(ErrorCode::bad_value, "version is half zero");
    }
    chunk.digest = in.u64();
    if (chunk.digest >= m61::kPrime) in.reject(ErrorCode::bad_value, "digest is not reduced");
    return chunk;
  });
}

Result<std::vector<UnmodifiedChunk>> decode_unmodified(ByteView bytes, std::int32_t edge) {
  KeyReader keys(edge);
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

Result<std::vector<MissingEdit>> decode_missing_edits(ByteView bytes, Sequence from) {
  return entries_of<MissingEdit>(bytes, kChunkEditsMax, [&from](ByteReader& in) {
    MissingEdit missing;
    const Sequence step = in.varint_max(kSequenceMax - from, "sequence exceeds 63 bits");
    if (in.ok() && step == 0) in.reject(ErrorCode::not_canonical, "sequences do not ascend");
    const std::uint64_t size = in.varint_max(kDescriptorBytesMax, "descriptor is too long");
    const ByteView edit = in.bytes(static_cast<std::size_t>(size));
    if (!in.ok()) return missing;
    auto decoded = decode_descriptor(edit);
    if (!decoded) {
      in.reject(decoded.error().code, decoded.error().what);
    } else {
      missing.edit = *std::move(decoded);
    }
    missing.seq = from = from + step;
    return missing;
  });
}

}  // namespace runstone
