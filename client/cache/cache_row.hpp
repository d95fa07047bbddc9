// Rows of a chunk cache: what a store keeps of a chunk or tile besides its key, and the checks that
// a row passes before it is used. The store on disk has a column for each field, and the store in a
// browser has the whole row as one record of bytes. Pure.
#pragma once
#include <cstdint>

#include "client/replica/cache_lookup.hpp"
#include "common/core/bytes.hpp"
#include "common/core/digest.hpp"
#include "common/runs/chunk.hpp"

namespace runstone {

struct CacheRow {
  Version version;
  std::uint64_t checksum = 0;  // over world, key and the other fields
  ByteView digest, data;       // digest_bytes(); bytes of chunk_codec.hpp
};

Bytes digest_bytes(const Digest& digest);
/// Returns the checksum of a row. Its own checksum is not read.
std::uint64_t checksum_of(const WorldId& world, const ChunkKey& key, const CacheRow& row);
/// Returns the chunk of a row, or null if the checksum is wrong, if the data is not a chunk of this
/// world, or if its voxels do not have the digest.
ChunkPtr chunk_of(const CachedWorld& world, const ChunkKey& key, const CacheRow& row);

/// Returns the row of a chunk as one record, little-endian:
///   u8 layout 1 | u32 epoch | u64 sequence | u64 checksum | digest, 16 bytes | data to the end
Bytes record_of(const WorldId& world, const ChunkKey& key, const Chunk& chunk);
/// Returns the chunk of a record, or null if it has another layout or as for chunk_of().
ChunkPtr chunk_of_record(const CachedWorld& world, const ChunkKey& key, ByteView record);

}  // namespace runstone
