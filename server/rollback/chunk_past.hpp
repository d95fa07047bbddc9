// chunk_past: a chunk as it was at a sequence. It starts with the newest stored form that is not
// younger: a snapshot, a chunk of a keyframe, the base or the generator's chunk. It applies the
// edits that touched the chunk since, which it finds by place in the log's index. It blocks on the
// disk. WorldAt serves callers that need many chunks of one moment.
#pragma once
#include <optional>

#include "common/edits/apply/replayed_chunk.hpp"
#include "common/generate/generator.hpp"
#include "common/runs/chunk.hpp"
#include "server/rollback/chunk_logs.hpp"
#include "server/store/world_reader.hpp"

namespace runstone {

/// Returns the chunk with all edits up to `at` and none later, in its cheapest axis order. Its
/// version is that of the last edit up to `at` that touched it. Requires lod 0. Fails as the
/// reader, and (bad_request) if the chunk's base is younger than `at`: a compaction removed the
/// edits before it.
StoreResult<Chunk> chunk_past(WorldReader& reader, const Generator& generator, const ChunkKey& key,
                              Sequence at, ReplayScratch& scratch);

/// The two steps of chunk_past(), for callers that read the log of many chunks at once.
/// Returns the newest stored form of a chunk that is not newer than `at`, in any axis order. Returns
/// nullopt if no form is stored: before its first edit the chunk is that of the generator. Fails as
/// chunk_past().
StoreResult<std::optional<Chunk>> stored_form(WorldReader& reader, const ChunkKey& key,
                                              Sequence at);
/// Returns that form with the edits up to `at`, which are read through `logs`. `edge` is that of the
/// world's chunks. The digest is wrong if that of `stored` is.
StoreResult<Chunk> replayed_to(Chunk stored, const ChunkKey& key, std::int32_t edge,
                               ChunkLogs& logs, Sequence at, ReplayScratch& scratch);

}  // namespace runstone
