// A chunk as it was before the first edit of the log.
#pragma once
#include "common/generate/generator.hpp"
#include "server/store/chunk_reader.hpp"

namespace runstone {

/// Returns the generator's chunk in its cheapest axis order, at version (0, 0). Requires lod 0 and
/// a chunk inside the world.
Chunk generated_chunk(const Generator& generator, const ChunkKey& key, std::uint16_t edge);

/// Returns the chunk of the base, or the generator's chunk if the base has none, in its cheapest
/// axis order. Its version is (0, 0), or that of the last edit that a compaction put into it.
/// Requires lod 0 and a chunk inside the world. Fails if the row is damaged; the error names file,
/// table and row. Blocks on the disk.
StoreResult<Chunk> base_chunk(ChunkReader& reader, const Generator& generator, const ChunkKey& key);
/// Returns the chunk of base_chunk() in any axis order.
StoreResult<Chunk> base_chunk_in_any_order(ChunkReader& reader, const Generator& generator,
                                           const ChunkKey& key);

}  // namespace runstone
