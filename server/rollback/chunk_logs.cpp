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

StoreResult<void> ChunkLogs::visit(const ChunkKey& key, Sequence first, Sequence last,
                                   const Each& each) {
  if (first > last) return {};
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
