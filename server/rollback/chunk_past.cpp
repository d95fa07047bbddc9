#include "server/rollback/chunk_past.hpp"

#include <utility>

#include "common/core/key_text.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {

StoreResult<std::optional<Chunk>> stored_form(WorldReader& reader, const ChunkKey& key,
                                              Sequence at) {
  auto newest = reader.load_kept(key, at);
  if (!newest) return newest;
  auto snapshot = reader.load_snapshot(key, at);
  if (!snapshot) return snapshot;
  if (snapshot->has_value() && (!newest->has_value() || (*newest)->version < (*snapshot)->version))
    return snapshot;
  if (newest->has_value()) return newest;
  auto base = reader.load_base(key);
  if (base && base->has_value() && (*base)->version.seq > at) {
    return failure(StoreError{
        StoreError::Kind::bad_request, reader.file(), "base chunk=" + text_of(key),
        "its edits were removed by retention up to seq=" + std::to_string((*base)->version.seq)});
  }
  return base;
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

namespace {

StoreResult<Chunk> past_at_one_moment(WorldReader& reader, const Generator& generator,
                                      const ChunkKey& key, Sequence at, ReplayScratch& scratch) {
  auto stored = stored_form(reader, key, at);
  if (!stored) return failure(stored.error());
  const std::uint16_t edge = reader.meta().chunk_edge;
  Chunk chunk = stored->has_value() ? **std::move(stored) : generated_chunk(generator, key, edge);
  chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
  ChunkLogs logs(reader);
  return replayed_to(std::move(chunk), key, edge, logs, at, scratch);
}

}  // namespace

StoreResult<Chunk> chunk_past(WorldReader& reader, const Generator& generator, const ChunkKey& key,
                              Sequence at, ReplayScratch& scratch) {
  // Stored form and log are read at one moment: retention moves edits from one to the other.
  if (const auto begun = reader.begin_reads(); !begun) return failure(begun.error());
  auto past = past_at_one_moment(reader, generator, key, at, scratch);
  if (const auto ended = reader.end_reads(); !ended && past) return failure(ended.error());
  return past;
}

}  // namespace runstone
