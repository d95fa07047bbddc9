#include "server/rollback/chunk_past.hpp"

#include <utility>

#include "common/core/key_text.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

StoreResult<Chunk> stored_form(WorldReader& reader, const Generator& generator, const ChunkKey& key,
                               Sequence at) {
  auto newest = reader.load_kept(key, at);
  if (!newest) return failure(newest.error());
  auto snapshot = reader.load_snapshot(key);
  if (!snapshot) return failure(snapshot.error());
  const bool is_old_enough = snapshot->has_value() && (*snapshot)->version.seq <= at;
  if (is_old_enough && (!newest->has_value() || (*newest)->version < (*snapshot)->version))
    newest = snapshot;
  if (newest->has_value()) {
    Chunk chunk = **std::move(newest);
    chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
    return chunk;
  }
  auto chunk = base_chunk(reader, generator, key);
  if (chunk && chunk->version.seq > at) {
    return failure(StoreError{
        StoreError::Kind::bad_request, reader.file(), "base chunk=" + text_of(key),
        "the log before sequence " + std::to_string(chunk->version.seq) + " was compacted"});
  }
  return chunk;
}

StoreResult<Chunk> replayed_to(Chunk stored, const ChunkKey& key, std::int32_t edge,
                               ChunkLogs& logs, Sequence at, ReplayScratch& scratch) {
  if (stored.version.seq >= at) return stored;
  const Sequence first = stored.version.seq + 1;
  ReplayedChunk replayed(std::move(stored), origin_of(key.at, edge));
  const auto read = logs.visit(key, first, at, [&](const EditRecord& record) {
    replayed.add(record.edit, record.version, scratch);
  });
  if (!read) return failure(read.error());
  replayed.flush(scratch);
  return std::move(replayed.chunk());
}

StoreResult<Chunk> chunk_past(WorldReader& reader, const Generator& generator, const ChunkKey& key,
                              Sequence at, ReplayScratch& scratch) {
  auto stored = stored_form(reader, generator, key, at);
  if (!stored) return stored;
  ChunkLogs logs(reader);
  return replayed_to(*std::move(stored), key, reader.meta().chunk_edge, logs, at, scratch);
}

}  // namespace runstone
