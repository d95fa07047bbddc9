#include "client/cache/cache_row.hpp"

#include <xxhash.h>

#include <algorithm>
#include <utility>

#include "protocol/chunks/chunk_codec.hpp"

namespace runstone {
namespace {

constexpr std::uint8_t kRecordLayout = 1;
constexpr std::size_t kDigestBytes = kDigestLanes * sizeof(std::uint64_t);

}  // namespace

Bytes digest_bytes(const Digest& digest) {
  Bytes bytes;
  ByteWriter out(bytes);
  for (const std::uint64_t lane : digest.lane) out.u64(lane);
  return bytes;
}

std::uint64_t checksum_of(const WorldId& world, const ChunkKey& key, const CacheRow& row) {
  Bytes bytes;
  ByteWriter out(bytes);
  out.bytes(world);
  out.u8(key.lod);
  for (const std::int32_t c : {key.at.x, key.at.y, key.at.z})
    out.u32(static_cast<std::uint32_t>(c));
  out.u32(row.version.epoch);
  out.u64(row.version.seq);
  out.bytes(row.digest);
  out.bytes(row.data);
  return XXH3_64bits(bytes.data(), bytes.size());
}

ChunkPtr chunk_of(const CachedWorld& world, const ChunkKey& key, const CacheRow& row) {
  if (row.checksum != checksum_of(world.id, key, row)) return nullptr;
  auto voxels = decode_chunk(row.data, Extent::cube(world.chunk_edge));
  if (!voxels) return nullptr;
  auto chunk = std::make_shared<Chunk>();
  chunk->voxels = *std::move(voxels);
  chunk->version = row.version;
  chunk->digest = digest_of(chunk->voxels);
  const Bytes found = digest_bytes(chunk->digest);
  if (!std::equal(found.begin(), found.end(), row.digest.begin(), row.digest.end())) return nullptr;
  return chunk;
}

Bytes record_of(const WorldId& world, const ChunkKey& key, const Chunk& chunk) {
  const Bytes digest = digest_bytes(chunk.digest);
  const Bytes data = encode_chunk(chunk.voxels, ChunkEncoding::packed);
  const CacheRow row{chunk.version, 0, digest, data};
  Bytes record;
  ByteWriter out(record);
  out.u8(kRecordLayout);
  out.u32(chunk.version.epoch);
  out.u64(chunk.version.seq);
  out.u64(checksum_of(world, key, row));
  out.bytes(digest);
  out.bytes(data);
  return record;
}

ChunkPtr chunk_of_record(const CachedWorld& world, const ChunkKey& key, ByteView record) {
  ByteReader in(record);
  const std::uint8_t layout = in.u8();
  CacheRow row;
  row.version.epoch = in.u32();
  row.version.seq = in.u64();
  row.checksum = in.u64();
  row.digest = in.bytes(kDigestBytes);
  row.data = in.bytes(in.left());
  if (!in.ok() || layout != kRecordLayout) return nullptr;
  return chunk_of(world, key, row);
}

}  // namespace runstone
