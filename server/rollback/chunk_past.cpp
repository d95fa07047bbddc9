#include "server/rollback/chunk_past.hpp"

#include <utility>
#include <vector>

#include "common/core/key_text.hpp"
#include "common/edits/edit_geometry.hpp"
#include "common/edits/edit_stack.hpp"
#include "common/runs/reorder.hpp"
#include "server/history/base_chunk.hpp"

namespace runstone {
namespace {

constexpr std::size_t kStackMax = 64;  // bounds memory; a sweep over more edits gains little

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
                              ApplyScratch& scratch) {
  auto chunk = stored_form(reader, generator, key, at);
  if (!chunk || chunk->version.seq >= at) return chunk;
  const std::int32_t edge = reader.meta().chunk_edge;
  const VoxelPos origin = origin_of(key.at, edge);
  std::vector<EditDescriptor> stack;
  ApplyResult result;
  const auto apply = [&] {
    apply_stack(chunk->voxels, chunk->digest, origin, stack, scratch, result);
    stack.clear();
  };
  LogQuery query;
  query.box = box_of(key.at, edge);
  query.first = chunk->version.seq + 1;
  query.last = at;
  const auto read = reader.query_log(query, [&](const EditRecord& record) {
    if (!touches(record.edit, *query.box)) return true;
    stack.push_back(record.edit);
    chunk->version = record.version;
    if (stack.size() == kStackMax) apply();
    return true;
  });
  if (!read) return Unexpected<StoreError>{read.error()};
  apply();
  return chunk;
}

}  // namespace runstone
