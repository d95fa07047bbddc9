// chunk_past: a chunk as it stood at a sequence, for one chunk at a time: the newest stored form that is not
// younger (snapshot, keyframe, base or generator), and the edits that touched the chunk since, by the log's
// index of places. Blocks on the disk.
#pragma once
#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "common/runs/chunk.hpp"
#include "server/rollback/chunk_logs.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// The chunk with all edits up to `at` and none later, in its cheapest axis order. The version is that of the last
/// edit up to `at` that touched it. Fails with what the store says, and (bad_request) if the chunk's base is younger
/// than `at`: the log before it was compacted. Requires lod 0.
StoreResult<Chunk> chunk_past(WorldReader& reader, const Generator& generator, const ChunkKey& key,
                              Sequence at, FollowScratch& scratch);
/// The same, with the log through `logs`, a view of the same reader.
StoreResult<Chunk> chunk_past(WorldReader& reader, const Generator& generator, ChunkLogs& logs,
                              const ChunkKey& key, Sequence at, FollowScratch& scratch);

}  // namespace runstone
