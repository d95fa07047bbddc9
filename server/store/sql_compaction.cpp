// The part of SqlStore that shortens the log: it applies edits to the base and deletes them. A
// compaction does it in one transaction, and retention in many small ones (fold_log()).
#include <algorithm>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/index_hint.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {
namespace {

// The bytes of a row besides its descriptor or its voxels, with its indexes (docs/edit-log.md,
// "Size").
constexpr std::uint64_t kRowBytes = 82;
// The stretches of the log that log_volume() reads, and the edits of each.
constexpr std::uint64_t kStretches = 32, kStretchEdits = 64;

}  // namespace

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

StoreResult<void> SqlStore::check_new_beginning(Sequence last) {
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  const auto range = log_.range(*head);
  if (!range) return failed(range.error());
  if (last >= range->last.version.seq) return {};
  auto next = database().prepare("SELECT count(*) FROM edit_log WHERE log = 0 AND seq = ?1");
  if (!next) return failed(next.error());
  const sql::ResetAtEnd reset_at_end(*next);
  const auto row = next->bind(1, static_cast<std::int64_t>(last + 1)).step();
  if (!row) return failed(row.error());
  if (next->integer(0) != 0) return {};
  return failure(StoreError{StoreError::Kind::corrupt, file(),
                            "edit_log seq=" + std::to_string(last + 1),
                            "is missing, so the log cannot begin with it"});
}

StoreResult<void> SqlStore::move_head(const LogEnd& head, bool lacks_none) {
  const Sequence last = head.version.seq;
  const auto counts = meta_table_.row_counts();  // before the head moves
  if (!counts) return failed(counts.error());
  if (auto there = check_new_beginning(last); !there) return there;
  if (auto put = meta_table_.put_log_head(head); !put) return put;
  auto eras = meta_table_.log_eras();
  if (!eras) return failed(eras.error());
  if (std::erase_if(*eras, [&](const LogEra& era) { return era.first <= last; }) > 0) {
    if (auto put = meta_table_.put_log_eras(*eras); !put) return put;
  }
  if (auto gone = delete_up_to("DELETE FROM edit_log WHERE log = 0 AND seq <= ?1", last); !gone)
    return gone;
  const auto segments = segments_.remove_up_to(last);
  if (!segments) return failed(segments.error());
  const auto keyframes = keyframes_.remove(last);
  if (!keyframes) return failed(keyframes.error());
  if (!*counts) return {};
  RowCounts counted = **counts;
  counted.head = last;
  counted.keyframes -= std::min(counted.keyframes, *keyframes);
  counted.segments -= std::min(counted.segments, *segments);
  if (counted.lost_edits > 0 && !lacks_none) {
    const auto lost = count_lost_edits();
    if (!lost) return failed(lost.error());
    counted.lost_edits = std::min(counted.lost_edits, *lost);
  }
  return put_counts(counted);
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
    return move_head(moment->at, false);
  });
  segments_.forget();
  if (compacted) meta_.materials = std::move(materials);
  return compacted;
}

StoreResult<bool> SqlStore::check_fold_chunks(const LogFold& fold, const LogRange& range) {
  const auto misfit = [&](const std::string& what) {
    return refuse("fold seq=" + std::to_string(fold.to.version.seq), what);
  };
  std::map<ChunkKey, Version> touched;
  LogEnd last;
  bool has_materials = false;
  const auto read =
      log_.read(range, fold.from + 1, fold.to.version.seq, [&](const EditRecord& record) {
        for (const ChunkCoord& at : touched_chunks(record.edit, meta_.chunk_edge))
          touched[{0, at}] = record.version;
        has_materials = has_materials || changes_materials(record.edit);
        last = {record.version, record.time_us};
        return true;
      });
  if (!read) return failed(read.error());
  if (last != fold.to) return misfit("is no edit of the log");
  if (touched.size() != fold.chunks.size())
    return misfit("has other chunks than those that its edits touch");
  auto expected = touched.begin();
  for (const auto& [key, chunk] : fold.chunks) {
    if (expected->first != key || expected->second != chunk->version)
      return misfit("chunk=" + text_of(key) + " is not as its edits left it");
    ++expected;
  }
  return has_materials;
}

StoreResult<void> SqlStore::fold_log(const LogFold& fold) {
  return write([&]() -> StoreResult<void> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    if (head->version.seq != fold.from) {
      return refuse("fold seq=" + std::to_string(fold.to.version.seq),
                    "begins at seq=" + std::to_string(fold.from) + ", and the head of the log is " +
                        std::to_string(head->version.seq));
    }
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    const Sequence last = fold.to.version.seq;
    const auto checkpoint = meta_table_.counter("checkpoint");
    if (!checkpoint) return failed(checkpoint.error());
    // The snapshots contain all edits up to the checkpoint, so no snapshot becomes older than its
    // base.
    if (last <= fold.from || last > range->last.version.seq || last > *checkpoint) {
      return refuse(
          "fold seq=" + std::to_string(last),
          "lies outside the log, or behind the checkpoint seq=" + std::to_string(*checkpoint));
    }
    const auto has_materials = check_fold_chunks(fold, *range);
    if (!has_materials) return failed(has_materials.error());
    if (auto saved = save_chunks(base_, fold.chunks); !saved) return saved;
    for (const Cause cause : {Cause::rights, Cause::textures}) {
      if (auto kept = keep_records(cause, last); !kept) return kept;
    }
    // meta_ stays as it is, because other threads read it: materials() reads the row.
    if (*has_materials) {
      if (const auto kept = keep_materials(last); !kept) return failed(kept.error());
    }
    return move_head(fold.to, true);  // check_fold_chunks() has read them
  });
}

StoreResult<bool> SqlStore::give_back_space(std::uint32_t pages) {
  bool has_more = false;
  auto given = write([&]() -> StoreResult<void> {
    const auto more = backend_->give_back(pages);
    if (!more) return failed(more.error());
    has_more = *more;
    return {};
  });
  if (!given) return failed(given.error());
  return has_more;
}

StoreResult<LogVolume> SqlStore::log_volume(Sequence last) {
  return at_one_moment<LogVolume>([&]() -> StoreResult<LogVolume> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    LogVolume volume;
    const Sequence until = std::min(last, range->last.version.seq);
    if (until < range->first) return volume;
    volume.edits = until + 1 - range->first;
    const auto sum_of =
        [&](const std::string& text) -> StoreResult<std::pair<std::uint64_t, std::uint64_t>> {
      auto row = database().prepare(text);
      if (!row) return failed(row.error());
      const sql::ResetAtEnd reset_at_end(*row);
      const auto there = row->bind(1, static_cast<std::int64_t>(until)).step();
      if (!there) return failed(there.error());
      return std::pair(static_cast<std::uint64_t>(row->integer(0)),
                       static_cast<std::uint64_t>(row->integer(1)));
    };
    // A sample of the log gives the estimate for all of it.
    std::uint64_t looked_at = 0, descriptor_bytes = 0;
    auto stretch = database().prepare(
        "SELECT count(*), CAST(coalesce(sum(length(descriptor)), 0) AS BIGINT) FROM edit_log "
        "WHERE log = 0 AND seq BETWEEN ?1 AND ?2");
    if (!stretch) return failed(stretch.error());
    for (std::uint64_t i = 0; i < kStretches; ++i) {
      const Sequence first = range->first + volume.edits / kStretches * i;
      const sql::ResetAtEnd reset_at_end(*stretch);
      const auto there =
          stretch->bind(1, static_cast<std::int64_t>(first))
              .bind(2, static_cast<std::int64_t>(std::min(until, first + kStretchEdits - 1)))
              .step();
      if (!there) return failed(there.error());
      looked_at += static_cast<std::uint64_t>(stretch->integer(0));
      descriptor_bytes += static_cast<std::uint64_t>(stretch->integer(1));
    }
    volume.log_bytes =
        volume.edits * (kRowBytes + descriptor_bytes / std::max<std::uint64_t>(looked_at, 1));
    const auto chunks = sum_of(
        "SELECT count(*), CAST(coalesce(sum(length(data)), 0) AS BIGINT) FROM keyframe_chunk "
        "WHERE seq <= ?1");
    if (!chunks) return failed(chunks.error());
    volume.keyframe_bytes = chunks->first * kRowBytes + chunks->second;
    const auto keyframes =
        sum_of("SELECT count(*), CAST(0 AS BIGINT) FROM keyframe WHERE seq <= ?1");
    if (!keyframes) return failed(keyframes.error());
    volume.keyframes = keyframes->first;
    const auto grown = sum_of(
        "SELECT count(*), CAST(coalesce(sum(length(data)), 0) AS BIGINT) FROM snapshot AS here "
        "WHERE seq <= ?1 AND NOT EXISTS (SELECT 1 FROM base WHERE base.lod = here.lod "
        "AND base.x = here.x AND base.y = here.y AND base.z = here.z)");
    if (!grown) return failed(grown.error());
    volume.base_bytes_max = grown->first * kRowBytes + grown->second;
    auto causes = database().prepare(
        "SELECT cause, count(*) FROM edit_log" + indexed_by(database(), "edit_log_cause") +
        " WHERE cause <> 0 AND seq <= ?1 GROUP BY cause ORDER BY cause");
    if (!causes) return failed(causes.error());
    causes->bind(1, static_cast<std::int64_t>(until));
    for (;;) {
      const auto more = causes->step();
      if (!more) return failed(more.error());
      if (!*more) return volume;
      volume.causes.emplace_back(static_cast<Cause>(causes->integer(0)),
                                 static_cast<std::uint64_t>(causes->integer(1)));
    }
  });
}

StoreResult<void> SqlStore::shrink() {
  if (access_ == StoreAccess::read_only) return refuse("", "is open for reading only");
  return backend_->shrink();
}

}  // namespace runstone
