#include "server/history/missing_edits.hpp"

#include <algorithm>
#include <utility>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

constexpr std::size_t kEditOverheadBytes = 8;  // about: of the edit's sequence and length

/// Returns true if the log has an edit of exactly this version that touches the chunk. A client's
/// copy of that version then is a state of this chunk.
StoreResult<bool> is_in_log(LogReader& store, const Version& version, const VoxelBox& box) {
  const auto range = store.log_range();
  if (!range) return failure(range.error());
  // Version 0 is the base, as long as no edit was compacted into it.
  if (version.seq == 0) return range->first == 1;
  if (version.seq < range->first || version.seq > range->last.version.seq) return false;
  bool is_here = false;
  const auto read = store.read_log(version.seq, version.seq, [&](const EditRecord& record) {
    is_here = record.version == version && touches(record.edit, box);
    return false;
  });
  if (!read) return failure(read.error());
  return is_here;
}

}  // namespace

StoreResult<std::optional<ChunkEdits>> missing_edits(LogReader& store, const ChunkKey& key,
                                                     const Chunk& chunk, const Version& from,
                                                     std::size_t bytes_max) {
  std::optional<ChunkEdits> out;
  const Sequence last = chunk.version.seq;
  if (last - from.seq > kUpdateStretchMax) return out;
  const VoxelBox box = box_of(key.at, static_cast<std::int32_t>(chunk.voxels.extent.x));
  const auto is_here = is_in_log(store, from, box);
  if (!is_here) return failure(is_here.error());
  if (!*is_here) return out;
  ChunkEdits update{key, from.seq, chunk.version, chunk.digest, {}};
  std::size_t bytes = 0, looks = 0;
  bool serves = true;
  LogQuery query;
  query.box = box;
  query.first = from.seq + 1;
  query.last = last;
  const auto read = store.query_log(query, [&](const EditRecord& record) {
    serves = ++looks <= kUpdateLooksMax;
    if (!serves || !touches(record.edit, box)) return serves;
    bytes += encode(record.edit).size() + kEditOverheadBytes;
    serves = bytes <= bytes_max && update.edits.size() < kChunkEditsMax;
    if (serves) update.edits.push_back({record.version.seq, record.edit});
    return serves;
  });
  if (!read) return failure(read.error());
  // Retention may have removed edits behind `from` since is_in_log().
  const auto range = store.log_range();
  if (!range) return failure(range.error());
  serves = serves && range->first <= std::max<Sequence>(from.seq, 1);
  if (serves && !update.edits.empty() && update.edits.back().seq == last) out = std::move(update);
  return out;
}

}  // namespace runstone
