#include "server/history/base_chunk.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {

Chunk generated_chunk(const Generator& generator, const ChunkKey& key, std::uint16_t edge) {
  RUNSTONE_ASSERT(key.lod == 0);
  Chunk chunk;
  chunk.voxels = in_cheapest_order(generator.generate(origin_of(key.at, edge), Extent::cube(edge)));
  chunk.digest = digest_of(chunk.voxels);
  return chunk;
}

StoreResult<Chunk> base_chunk(ChunkReader& reader, const Generator& generator,
                              const ChunkKey& key) {
  auto chunk = base_chunk_in_any_order(reader, generator, key);
  if (chunk) chunk->voxels = in_cheapest_order(std::move(chunk->voxels));
  return chunk;
}

StoreResult<Chunk> base_chunk_in_any_order(ChunkReader& reader, const Generator& generator,
                                           const ChunkKey& key) {
  RUNSTONE_ASSERT(key.lod == 0);
  auto stored = reader.load_base(key);
  if (!stored) return failure(stored.error());
  if (!stored->has_value()) return generated_chunk(generator, key, reader.meta().chunk_edge);
  return **std::move(stored);
}

}  // namespace runstone
