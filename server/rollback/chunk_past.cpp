#include "server/rollback/chunk_past.hpp"

#include <utility>

#include "common/core/key_text.hpp"
#include "common/edits/edit_geometry.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {
namespace {

StoreResult<Chunk> stored_form(Store& reader, const Generator& generator, const ChunkKey& key, Sequence at) {
  auto newest = reader.load_kept(key, at);
  if (!newest) return Unexpected<StoreError>{newest.error()};
  auto snapshot = reader.load_snapshot(key);
  if (!snapshot) return Unexpected<StoreError>{snapshot.error()};
  const bool is_old_enough = snapshot->has_value() && (*snapshot)->version.seq <= at;
  if (is_old_enough && (!newest->has_value() || (*newest)->version < (*snapshot)->version)) newest = snapshot;
  if (newest->has_value()) {
    Chunk chunk = **std::move(newest);
    chunk.voxels = in_cheapest_order(std::move(chunk.voxels));
    return chunk;
  }
  auto chunk = base_chunk(reader, generator, key);
  if (chunk && chunk->version.seq > at) {
    return Unexpected<StoreError>{
        {StoreError::Kind::bad_request, reader.file(), "base chunk=" + text_of(key),
         "the log before sequence " + std::to_string(chunk->version.seq) + " was compacted"}};
  }
  return chunk;
}

}  // namespace

StoreResult<Chunk> chunk_past(Store& reader, const Generator& generator, const ChunkKey& key, Sequence at,
                              FollowScratch& scratch) {
  auto start = stored_form(reader, generator, key, at);
  if (!start || start->version.seq >= at) return start;
  const std::int32_t edge = reader.meta().chunk_edge;
  LogQuery query;
  query.box = box_of(key.at, edge);
  query.first = start->version.seq + 1;
  query.last = at;
  FollowedChunk followed(*std::move(start), origin_of(key.at, edge));
  const auto read = reader.query_log(query, [&](const EditRecord& record) {
    if (touches(record.edit, *query.box)) followed.add(record.edit, record.version, scratch);
    return true;
  });
  if (!read) return Unexpected<StoreError>{read.error()};
  followed.settle(scratch);
  return std::move(followed.chunk());
}

}  // namespace runstone
