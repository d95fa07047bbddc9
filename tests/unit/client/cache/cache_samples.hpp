// Worlds and chunks for the tests of the chunk caches. No two chunks have the same voxels.
#pragma once
#include <catch2/catch.hpp>
#include <cstdint>
#include <memory>
#include <vector>

#include "client/replica/cache_lookup.hpp"
#include "common/core/hash.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

inline constexpr unsigned kEdge = 16;

inline CachedWorld world_at(Epoch epoch, Sequence durable, Sequence head, std::uint8_t id = 1) {
  CachedWorld world;
  world.id = {id};
  world.chunk_edge = kEdge;
  world.mark = {epoch, durable, head};
  return world;
}

inline ChunkKey key_at(std::int32_t i) { return {0, {i % 16, -3 + i / 256, (i / 16) % 16}}; }

/// Returns voxels that no other chunk or version has.
inline ChunkPtr chunk_at(const ChunkKey& key, const Version& version) {
  SplitMix64 rng{mix64(version.seq * 31 + version.epoch) ^
                 static_cast<std::uint64_t>(key.at.x * 7919 + key.at.y * 104729 + key.at.z)};
  auto chunk = std::make_shared<Chunk>();
  chunk->voxels = random_chunk(rng, Extent::cube(kEdge), AxisOrder::yxz, 200);
  chunk->digest = digest_of(chunk->voxels);
  chunk->version = version;
  return chunk;
}

inline std::vector<KeyedChunk> chunks_at(std::int32_t first, std::int32_t count,
                                         const Version& version) {
  std::vector<KeyedChunk> out;
  for (std::int32_t i = first; i < first + count; ++i)
    out.emplace_back(key_at(i), chunk_at(key_at(i), version));
  return out;
}

inline std::vector<ChunkKey> keys_of(std::int32_t first, std::int32_t count) {
  std::vector<ChunkKey> out;
  for (std::int32_t i = first; i < first + count; ++i) out.push_back(key_at(i));
  return out;
}

/// Checks that each chunk found is the one that was stored with its key and version.
inline void require_true(const std::vector<KeyedChunk>& found) {
  for (const auto& [key, chunk] : found) REQUIRE(*chunk == *chunk_at(key, chunk->version));
}

}  // namespace runstone::test
