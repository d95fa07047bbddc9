#include "server/history/base_chunk.hpp"

#include <utility>

#include "common/core/assert.hpp"
#include "common/runs/reorder.hpp"

namespace runstone {

StoreResult<Chunk> base_chunk(ChunkReader& reader, const Generator& generator,
                              const ChunkKey& key) {
  RUNSTONE_ASSERT(key.lod == 0);
  auto stored = reader.load_base(key);
  if (!stored) return Unexpected<StoreError>{stored.error()};
  Chunk chunk;
  if (stored->has_value()) {
    chunk = **std::move(stored);
  } else {
    const std::uint16_t edge = reader.meta().chunk_edge;
    chunk.voxels = generator.generate(origin_of(key.at, edge), Extent::cube(edge));
    chunk.digest = digest_of(chunk.voxels);
  }
  chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
  return chunk;
}

}  // namespace runstone
