// SqlStore::check(): verifies every row of every table, and the relations between the tables.
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {

StoreResult<void> SqlStore::check_chunks(ChunkTable& table) {
  const auto rows = rows_of(table);
  if (!rows) return failed(rows.error());
  // Both are read after the rows, because a running server only increases them.
  const auto range = log_range();
  if (!range) return failed(range.error());
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  // If a base chunk contained an edit of the log, replay would apply that edit twice.
  const bool is_base = &table == &base_;
  const Version newest = is_base ? head->version : range->last.version;
  for (const auto& [key, version, digest, completed] : *rows) {
    const auto chunk = table.load(key, kSequenceMax, meta_.chunk_edge, RowCheck::voxels);
    if (!chunk) return failed(chunk.error());
    if (version > newest) {
      return failure(StoreError{StoreError::Kind::corrupt, file(),
                                table.name() + " chunk=" + text_of(key),
                                is_base ? "holds edits that are in the log as well"
                                        : "is newer than the end of the log"});
    }
  }
  return {};
}

StoreResult<void> SqlStore::check_log_rows() {
  // The end of the log is read first, because a running server adds watermarks and eras, too.
  const auto last = last_sequence();
  if (!last) return failed(last.error());
  const auto all = player_table_.high_waters();
  if (!all) return failed(all.error());
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  auto eras = meta_table_.log_eras();
  if (!eras) return failed(eras.error());
  std::erase_if(*eras, [&](const LogEra& era) { return era.first > *last; });
  Watermarks marks;
  for (const HighWater& row : all->rows) marks[{row.author, row.instance}] = row;
  std::vector<LogEra> found;
  TimeUs before_us = head->version.seq == 0 ? std::numeric_limits<TimeUs>::min() : head->time_us;
  std::optional<StoreError> wrong;
  auto read = read_log(1, *last, [&](const EditRecord& record) {
    const auto mark = marks.find({record.op.author, record.op.instance});
    if (mark == marks.end() || mark->second.resolved < record.op.seq ||
        mark->second.last_us < record.time_us) {
      wrong =
          StoreError{StoreError::Kind::corrupt, file(),
                     "player_instance author=" + std::to_string(record.op.author) +
                         " instance=" + std::to_string(record.op.instance),
                     "is behind the log, which holds client edit " + std::to_string(record.op.seq)};
    } else if (corrects_time(record)) {
      found.push_back({record.version.seq, record.time_us});
    } else if (record.time_us < before_us) {
      wrong = StoreError{StoreError::Kind::corrupt, file(),
                         "edit_log seq=" + std::to_string(record.version.seq),
                         "is earlier than the edit before it, and corrects no time"};
    }
    before_us = record.time_us;
    return !wrong.has_value();
  });
  if (!read) return read;
  if (wrong) return failure(*std::move(wrong));
  if (found == *eras) return {};
  return failure(StoreError{StoreError::Kind::corrupt, file(),
                            std::string("meta key=") + kLogErasKey,
                            "does not list the corrections of the time that the log holds"});
}

StoreResult<void> SqlStore::check_segments_cover_log() {
  // The range is read before the segments, because a running server adds to both.
  const auto range = log_range();
  if (!range) return failed(range.error());
  const auto segments = segments_.find({}, 1, kSequenceMax);
  if (!segments) return failed(segments.error());
  std::map<AuthorId, const LogSegment*> open;
  auto next = segments->begin();
  Sequence uncovered = 0;
  auto read = read_log(range->first, range->last.version.seq, [&](const EditRecord& record) {
    const Sequence seq = record.version.seq;
    for (; next != segments->end() && next->first <= seq; ++next) open[next->author] = &*next;
    const auto found = open.find(record.op.author);
    const VoxelBox box = bounding_box(record.edit);
    if (found == open.end() || found->second->last < seq ||
        (!box.empty() && intersect(found->second->box, box) != box)) {
      uncovered = seq;
    }
    return uncovered == 0;
  });
  if (!read || uncovered == 0) return read;
  return failure(StoreError{StoreError::Kind::corrupt, file(), "log_box",
                            "lacks edit_log seq=" + std::to_string(uncovered)});
}

StoreResult<void> SqlStore::check_keyframes() {
  // All reads are in one transaction, because a running server adds rows and keyframes.
  return at_one_moment<void>([&]() -> StoreResult<void> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    const auto keyframes = keyframes_.all();
    if (!keyframes) return failed(keyframes.error());
    const auto start = completed(*head);
    if (!start) return failed(start.error());
    const auto rows = keyframes_.rows(kSequenceMax);
    if (!rows) return failed(rows.error());
    for (const StoredChunk& row : *rows) {
      const auto loaded = load_stored(row);
      if (!loaded) return failed(loaded.error());
      if (!loaded->has_value() || row.version <= head->version ||
          row.version > range->last.version) {
        return failure(StoreError{
            StoreError::Kind::corrupt, file(),
            "keyframe_chunk chunk=" + text_of(row.key) + " seq=" + std::to_string(row.version.seq),
            "has a version that is not within the log"});
      }
    }
    if (auto proved = keyframes_.prove(*keyframes, *start, *rows); !proved) return proved;
    for (const Keyframe& keyframe : *keyframes) {
      if (auto fits = check_keyframe(keyframe, *range); !fits) return fits;
    }
    return {};
  });
}

StoreResult<void> SqlStore::check() {
  if (auto sound = backend_->check(); !sound) return sound;
  if (const auto rows = meta_table_.read_all(); !rows) return failed(rows.error());
  if (const auto places = saved_places(); !places) return failed(places.error());
  if (const auto clock = saved_clock(); !clock) return failed(clock.error());
  if (const auto rows = players(); !rows) return failed(rows.error());
  if (const auto rows = names_.names(); !rows) return failed(rows.error());
  if (const auto rows = name_claims(); !rows) return failed(rows.error());
  const auto rights = read_rights([](const EditRecord&) { return true; });
  if (!rights) return failed(rights.error());
  const auto textures = read_textures([](const EditRecord&) { return true; });
  if (!textures) return failed(textures.error());
  if (const auto table = materials(); !table) return failed(table.error());
  if (const auto seq = checkpoint(); !seq) return failed(seq.error());
  // A watermark that the log proves to be missing is named before the rows are counted.
  // Retention of a running server removes rows of the log, eras and segments together.
  if (auto rows = at_one_moment<void>([this] { return check_log_rows(); }); !rows) return rows;
  if (const auto rows = high_waters(); !rows) return failed(rows.error());
  if (auto segments = at_one_moment<void>([this] { return check_segments_cover_log(); }); !segments)
    return segments;
  if (auto chunks = check_chunks(base_); !chunks) return chunks;
  if (auto chunks = check_chunks(snapshots_); !chunks) return chunks;
  if (auto keyframes = check_keyframes(); !keyframes) return keyframes;
  if (auto library = check_library(); !library) return library;
  return check_counts();
}

}  // namespace runstone
