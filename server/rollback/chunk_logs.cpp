#include "server/rollback/chunk_logs.hpp"

#include <algorithm>
#include <iterator>

#include "common/edits/descriptor/edit_geometry.hpp"

namespace runstone {
namespace {

std::size_t bytes_of(const EditRecord& record) {
  std::size_t bytes = sizeof record;
  if (const auto* stroke = std::get_if<FillStroke>(&record.edit.shape)) {
    bytes += stroke->points.size() * sizeof(VoxelPos);
  } else if (const auto* paste = std::get_if<Paste>(&record.edit.shape)) {
    bytes += paste->clipboard->byte_size();
  }
  return bytes;
}

/// Returns true if one of the chunks, the keys of a map, overlaps a box that is not empty, and needs
/// edits up to `last`. Cost: O(log chunks) for each chunk of a box with few of them; of larger boxes
/// O(1), and the answer may then be true for a box between the chunks.
template <class Map>
bool is_needed_by_one_of(const Map& chunks, const VoxelBox& box, Sequence last, std::int32_t edge) {
  constexpr std::int64_t kLookedForMax = 64;
  const ChunkCoord low = chunk_of(box.min, edge),
                   high = chunk_of({box.max.x - 1, box.max.y - 1, box.max.z - 1}, edge);
  std::int64_t count = 1;
  for (const std::int64_t side :
       {std::int64_t{high.x} - low.x + 1, std::int64_t{high.y} - low.y + 1,
        std::int64_t{high.z} - low.z + 1}) {
    count *= side;
    if (count > kLookedForMax) return true;
  }
  for (std::int32_t x = low.x; x <= high.x; ++x) {
    for (std::int32_t y = low.y; y <= high.y; ++y) {
      const ChunkKey end{0, {x, y, high.z}};
      for (auto at = chunks.lower_bound({0, {x, y, low.z}}); at != chunks.end() && at->first <= end;
           ++at) {
        if (at->second.first <= last) return true;
      }
    }
  }
  return false;
}

}  // namespace

StoreResult<void> ChunkLogs::read(const ChunkKey& key, Sequence first, Sequence last,
                                  const Each& each) {
  LogQuery query;
  query.box = box_of(key.at, reader_.meta().chunk_edge);
  query.first = first;
  query.last = last;
  bool is_wanted = true;
  const auto done = reader_.query_log(query, [&](const EditRecord& record) {
    is_wanted = !should_continue_ || should_continue_();
    if (is_wanted && touches(record.edit, *query.box)) each(record);
    return is_wanted;
  });
  if (done && !is_wanted) return cancelled(reader_);
  return done;
}

StoreResult<void> ChunkLogs::keep(const ChunkKey& key, Kept& kept, Sequence first, Sequence last) {
  const bool is_new = kept.first > kept.last;
  const auto fetch = [&](Sequence from, Sequence until, std::vector<EditRecord>& out) {
    return read(key, from, until, [&](const EditRecord& record) {
      if (kept.is_too_large) return;
      out.push_back(record);
      kept_bytes_ += bytes_of(record);
      kept.is_too_large = kept_bytes_ > kept_bytes_max_;
    });
  };
  if (is_new || last > kept.last) {
    const auto done = fetch(is_new ? first : kept.last + 1, last, kept.records);
    if (!done) return done;
    if (is_new) kept.first = first;
    kept.last = last;
  }
  if (first < kept.first) {
    std::vector<EditRecord> older;
    const auto done = fetch(first, kept.first - 1, older);
    if (!done) return done;
    std::move(kept.records.begin(), kept.records.end(), std::back_inserter(older));
    kept.records = std::move(older);
    kept.first = first;
  }
  if (kept.is_too_large) {
    for (const EditRecord& record : kept.records) kept_bytes_ -= bytes_of(record);
    kept.records = {};
  }
  return {};
}

StoreResult<bool> ChunkLogs::read_ahead(const std::vector<Need>& needs, Sequence last) {
  ahead_ = {};
  if (needs.empty()) return true;
  const std::int32_t edge = reader_.meta().chunk_edge;
  LogQuery query;
  query.first = kSequenceMax;
  query.last = last;
  for (const Need& need : needs) {
    ahead_.chunks[need.key].first = need.first;
    const VoxelBox box = box_of(need.key.at, edge);
    query.box = query.box ? bounding_box(*query.box, box) : box;
    query.first = std::min(query.first, need.first);
  }
  ahead_.last = last;
  if (query.first > last) return true;
  query.wants = [&](const VoxelBox& box, Sequence until) {
    return box.empty() || is_needed_by_one_of(ahead_.chunks, box, until, edge);
  };
  bool is_wanted = true;
  std::size_t bytes = 0;
  std::vector<ChunkCoord> touched;
  const auto done = reader_.query_log(query, [&](const EditRecord& record) {
    is_wanted = !should_continue_ || should_continue_();
    bool is_kept = false;
    touched_chunks(record.edit, edge, touched);
    for (const ChunkCoord at : touched) {
      const auto chunk = ahead_.chunks.find({0, at});
      if (chunk == ahead_.chunks.end() || record.version.seq < chunk->second.first) continue;
      chunk->second.records.push_back(ahead_.records.size());
      bytes += sizeof(std::size_t);
      is_kept = true;
    }
    if (is_kept) {
      ahead_.records.push_back(record);
      bytes += bytes_of(record);
    }
    return is_wanted && bytes <= kAheadBytesMax;
  });
  const bool is_complete = done && is_wanted && bytes <= kAheadBytesMax;
  if (!is_complete) ahead_ = {};
  if (!done) return failure(done.error());
  if (!is_wanted) return cancelled(reader_);
  return is_complete;
}

std::optional<std::vector<const EditRecord*>> ChunkLogs::in_memory(const ChunkKey& key,
                                                                   Sequence first,
                                                                   Sequence last) const {
  const auto ahead = ahead_.chunks.find(key);
  if (ahead == ahead_.chunks.end() || ahead->second.first > first || last > ahead_.last)
    return std::nullopt;
  std::vector<const EditRecord*> out;
  out.reserve(ahead->second.records.size());
  for (const std::size_t place : ahead->second.records) {
    const EditRecord& record = ahead_.records[place];
    if (record.version.seq >= first && record.version.seq <= last) out.push_back(&record);
  }
  return out;
}

StoreResult<void> ChunkLogs::visit(const ChunkKey& key, Sequence first, Sequence last,
                                   const Each& each) {
  if (first > last) return {};
  if (const auto records = in_memory(key, first, last)) {
    for (const EditRecord* record : *records) each(*record);
    return {};
  }
  if (kept_bytes_max_ == 0) return read(key, first, last, each);
  Kept& kept = kept_[key];
  if (!kept.is_too_large) {
    const auto done = keep(key, kept, first, last);
    if (!done) return done;
  }
  if (kept.is_too_large) return read(key, first, last, each);
  const auto begin =
      std::partition_point(kept.records.begin(), kept.records.end(),
                           [&](const EditRecord& r) { return r.version.seq < first; });
  for (auto record = begin; record != kept.records.end() && record->version.seq <= last; ++record)
    each(*record);
  return {};
}

}  // namespace runstone
