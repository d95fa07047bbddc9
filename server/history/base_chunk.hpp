// base_chunk: a chunk as it was before the first edit of the log.
#pragma once
#include "common/generate/generator.hpp"
#include "server/store/chunk_reader.hpp"

namespace runstone {

/// The base row of the chunk, else what the generator makes, in its cheapest axis order, at version (0, 0) or at that of
/// the compaction which completed it. Requires lod 0 and a chunk inside the world. Blocks on the disk; an error names
/// file, table and row.
StoreResult<Chunk> base_chunk(ChunkReader& reader, const Generator& generator, const ChunkKey& key);

}  // namespace runstone
