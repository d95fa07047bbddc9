// The part of SqlStore that shortens the log: the edits are applied to the base, then they are
// deleted.
#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/key_text.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {

StoreResult<void> SqlStore::delete_up_to(const char* text, Sequence last) {
  auto statement = database().prepare(text);
  if (!statement) return failed(statement.error());
  return store_result(statement->bind(1, static_cast<std::int64_t>(last)).run());
}

StoreResult<void> SqlStore::complete_base(const StoredMoment& moment) {
  auto base_fold = meta_table_.fold(base_.fold_key());
  if (!base_fold) return failed(base_fold.error());
  auto snapshot_fold = meta_table_.fold(snapshots_.fold_key());
  if (!snapshot_fold) return failed(snapshot_fold.error());
  const auto snapshots = rows_of(snapshots_);
  if (!snapshots) return failed(snapshots.error());
  std::vector<std::pair<ChunkKey, Version>> newer_snapshots;
  std::map<ChunkKey, Version> saved_at;
  for (const StoredChunk& snapshot : *snapshots) saved_at[snapshot.key] = snapshot.version;
  for (const StoredChunk& stored : moment.chunks) {
    const auto snapshot = saved_at.find(stored.key);
    // An older snapshot could not be brought up to date, since the edits up to the new head are
    // deleted.
    const bool needs_snapshot = snapshot == saved_at.end() || snapshot->second < stored.version;
    if (stored.is_base && !needs_snapshot) continue;
    const auto chunk = load_stored(stored);
    if (!chunk) return failed(chunk.error());
    if (!chunk->has_value()) {
      return failure(StoreError{StoreError::Kind::corrupt, file(),
                                "keyframe_chunk chunk=" + text_of(stored.key), "is missing"});
    }
    if (!stored.is_base) {
      if (auto saved = base_.save(stored.key, **chunk, meta_.chunk_edge, *base_fold); !saved)
        return saved;
    }
    if (needs_snapshot) {
      if (auto saved = snapshots_.save(stored.key, **chunk, meta_.chunk_edge, *snapshot_fold);
          !saved)
        return saved;
      newer_snapshots.emplace_back(stored.key, stored.version);
    }
  }
  if (auto removed = tiles_->remove_stale(newer_snapshots); !removed) return removed;
  if (auto put = meta_table_.put_fold(base_.fold_key(), *base_fold); !put) return put;
  return meta_table_.put_fold(snapshots_.fold_key(), *snapshot_fold);
}

StoreResult<void> SqlStore::compact(Sequence keyframe) {
  MaterialTable materials;
  auto compacted = write([&]() -> StoreResult<void> {
    const auto moment = stored_moment(keyframe);  // its digest is checked
    if (!moment) return failed(moment.error());
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    if (moment->at.version.seq != keyframe || keyframe < range->first) {
      return refuse("keyframe seq=" + std::to_string(keyframe), "is not there");
    }
    if (auto fits = check_keyframe({moment->at, 0, {}}, *range); !fits) return fits;
    if (auto completed = complete_base(*moment); !completed) return completed;
    const auto checkpoint = meta_table_.counter("checkpoint");
    if (!checkpoint) return failed(checkpoint.error());
    if (*checkpoint < keyframe) {
      if (auto put = meta_table_.put("checkpoint", static_cast<std::int64_t>(keyframe)); !put)
        return put;
    }
    for (const Cause cause : {Cause::rights, Cause::textures}) {
      if (auto kept = keep_records(cause, keyframe); !kept) return kept;
    }
    auto kept_materials = keep_materials(keyframe);
    if (!kept_materials) return failed(kept_materials.error());
    materials = *std::move(kept_materials);
    const auto counts = meta_table_.row_counts();  // before the head moves
    if (!counts) return failed(counts.error());
    if (auto put = meta_table_.put_log_head(moment->at); !put) return put;
    auto eras = meta_table_.log_eras();
    if (!eras) return failed(eras.error());
    if (std::erase_if(*eras, [&](const LogEra& era) { return era.first <= keyframe; }) > 0) {
      if (auto put = meta_table_.put_log_eras(*eras); !put) return put;
    }
    if (auto gone = delete_up_to("DELETE FROM edit_log WHERE log = 0 AND seq <= ?1", keyframe);
        !gone)
      return gone;
    // A segment that continues after the head stays as it is. Its box may be larger than needed.
    if (auto gone = delete_up_to("DELETE FROM log_box WHERE last_seq <= ?1", keyframe); !gone)
      return gone;
    if (auto gone = keyframes_.remove(keyframe); !gone) return gone;
    if (!*counts) return {};
    const auto left = counted_rows();
    if (!left) return failed(left.error());
    RowCounts counted = **counts;
    counted.head = keyframe;
    counted.keyframes = left->keyframes;
    counted.segments = left->segments;
    if (counted.lost_edits > 0) {
      const auto lost = count_lost_edits();
      if (!lost) return failed(lost.error());
      counted.lost_edits = std::min(counted.lost_edits, *lost);
    }
    return put_counts(counted);
  });
  segments_.forget();
  if (compacted) meta_.materials = std::move(materials);
  return compacted;
}

StoreResult<void> SqlStore::shrink() {
  if (access_ == StoreAccess::read_only) return refuse("", "is open for reading only");
  return backend_->shrink();
}

}  // namespace runstone
