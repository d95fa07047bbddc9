#include "protocol/codec/key_list.hpp"

#include "common/core/assert.hpp"
#include "common/core/m61.hpp"

namespace runstone {

void KeyWriter::put(ByteWriter& out, const ChunkKey& key) {
  RUNSTONE_ASSERT(key.lod == level_ && (is_first_ || last_ < key.at));
  is_first_ = false;
  out.svarint(std::int64_t{key.at.x} - last_.x);
  out.svarint(std::int64_t{key.at.y} - last_.y);
  out.svarint(std::int64_t{key.at.z} - last_.z);
  last_ = key.at;
}

KeyReader::KeyReader(std::int32_t edge, std::uint8_t level)
    : level_(level), reach_(kWorldLimit / edge >> level) {}

ChunkKey KeyReader::take(ByteReader& in) {
  ChunkCoord at;
  at.x = next(in, last_.x);
  at.y = next(in, last_.y);
  at.z = next(in, last_.z);
  if (!is_first_ && in.ok() && at <= last_)
    in.reject(ErrorCode::not_canonical, "chunk keys do not ascend");
  is_first_ = false;
  last_ = at;
  return {level_, at};
}

std::int32_t KeyReader::next(ByteReader& in, std::int32_t before) const {
  const std::int64_t low = -std::int64_t{reach_} - before;
  const std::int64_t high = std::int64_t{reach_} - 1 - before;
  return static_cast<std::int32_t>(before +
                                   in.svarint_in(low, high, "chunk key is outside the world"));
}

void put_version(ByteWriter& out, const Version& version) {
  out.varint(version.epoch);
  if (version.epoch != 0) out.varint(version.seq);
}

Version take_version(ByteReader& in) {
  Version version;
  version.epoch = static_cast<Epoch>(in.varint_max(0xffff'ffff, "epoch exceeds 32 bits"));
  if (version.epoch == 0) return version;
  version.seq = in.varint_max(kSequenceMax, "sequence exceeds 63 bits");
  if (in.ok() && version.seq == 0) in.reject(ErrorCode::bad_value, "version is half zero");
  return version;
}

void put_digest(ByteWriter& out, const Digest& digest) {
  for (const std::uint64_t lane : digest.lane) out.u64(lane);
}

Digest take_digest(ByteReader& in) {
  Digest digest;
  for (std::uint64_t& lane : digest.lane) lane = take_lane(in);
  return digest;
}

std::uint64_t take_lane(ByteReader& in) {
  const std::uint64_t lane = in.u64();
  if (lane >= m61::kPrime) in.reject(ErrorCode::bad_value, "digest is not reduced");
  return lane;
}

Bytes encode_keys(std::span<const ChunkKey> keys) {
  RUNSTONE_ASSERT(!keys.empty());
  Bytes bytes;
  ByteWriter out(bytes);
  KeyWriter writer;
  for (const ChunkKey& key : keys) writer.put(out, key);
  return bytes;
}

Result<std::vector<ChunkKey>> decode_keys(ByteView bytes, std::size_t count_max,
                                          std::int32_t edge) {
  KeyReader keys(edge);
  return entries_of<ChunkKey>(bytes, count_max, [&keys](ByteReader& in) { return keys.take(in); });
}

}  // namespace runstone
