// The part of SqlStore that reads and writes stored moments: keyframes, and the base that a
// compaction completed.
#include <utility>

#include "common/core/key_text.hpp"
#include "server/store/removed_history.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {

StoreResult<std::vector<Keyframe>> SqlStore::keyframes() { return keyframes_.all(); }

StoreResult<std::vector<StoredChunk>> SqlStore::keyframe_chunks() {
  return keyframes_.rows(kSequenceMax);
}

StoreResult<std::vector<StoredChunk>> SqlStore::base_chunks() { return rows_of(base_); }

StoreResult<std::vector<StoredChunk>> SqlStore::completed(const LogEnd& head) {
  // An import may have made very many base chunks. None contains an edit until the first
  // compaction.
  if (head.version.seq == 0) return std::vector<StoredChunk>();
  auto rows = rows_of(base_);
  if (rows) std::erase_if(*rows, [](const StoredChunk& row) { return row.version == Version{}; });
  return rows;
}

StoreResult<StoredMoment> SqlStore::stored_moment(Sequence at) {
  return at_one_moment<StoredMoment>([&]() -> StoreResult<StoredMoment> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    if (at < head->version.seq) {
      return refuse("edit_log", "begins at seq=" + std::to_string(head->version.seq + 1) +
                                    ": the world at seq=" + std::to_string(at) + " was " +
                                    removed_up_to(*head) + ", which is the earliest one left");
    }
    auto start = completed(*head);
    if (!start) return failed(start.error());
    auto all = keyframes();
    if (!all) return failed(all.error());
    while (!all->empty() && all->back().at.version.seq > at) all->pop_back();
    if (all->empty()) return StoredMoment{*head, *std::move(start)};
    const Keyframe& newest = all->back();
    const auto rows = keyframes_.rows(newest.at.version.seq);
    if (!rows) return failed(rows.error());
    if (auto proved = keyframes_.prove({newest}, *start, *rows); !proved)
      return failed(proved.error());
    return StoredMoment{newest.at, newest_of(*std::move(start), *rows)};
  });
}

StoreResult<std::optional<Chunk>> SqlStore::load_stored(const StoredChunk& chunk) {
  const auto matching = [&](StoreResult<std::optional<Chunk>> loaded) {
    // Retention or a compaction may have replaced the keyframe.
    if (loaded && loaded->has_value() && (*loaded)->version != chunk.version) loaded->reset();
    return loaded;
  };
  auto loaded = matching(
      chunk.is_base ? load_base(chunk.key)
                    : keyframes_.load(chunk.key, chunk.version.seq, meta_.chunk_edge, row_check_));
  if (!loaded) return loaded;
  bool is_base = chunk.is_base;
  if (!loaded->has_value() && !is_base) {
    // Retention deletes rows of keyframes and puts chunks of the same versions into the base.
    loaded = matching(load_base(chunk.key));
    is_base = true;
  }
  if (!loaded || !loaded->has_value()) return loaded;
  if ((*loaded)->digest == chunk.digest) return loaded;
  return failure(
      StoreError{StoreError::Kind::corrupt, file(),
                 std::string(is_base ? "base" : "keyframe_chunk") + " chunk=" + text_of(chunk.key),
                 "has another digest than its moment"});
}

StoreResult<std::optional<Chunk>> SqlStore::load_kept(const ChunkKey& key, Sequence at) {
  return keyframes_.newest(key, at, meta_.chunk_edge, row_check_);
}

StoreResult<void> SqlStore::check_keyframe(const Keyframe& keyframe, const LogRange& range) {
  const Sequence seq = keyframe.at.version.seq;
  std::string what;
  if (seq < range.first || seq > range.last.version.seq) {
    what = "is not within the log";
  } else {
    auto reader = log_.reader();
    if (!reader) return failed(reader.error());
    const auto record = log_.read_one(*reader, seq);
    if (!record) return failed(record.error());
    if (LogEnd{record->version, record->time_us} != keyframe.at)
      what = "has another epoch or time than its edit";
  }
  if (what.empty()) return {};
  return failure(StoreError{StoreError::Kind::corrupt, file(),
                            "keyframe seq=" + std::to_string(seq), std::move(what)});
}

StoreResult<void> SqlStore::save_keyframe(ChunkSpan chunks,
                                          const std::optional<Keyframe>& keyframe) {
  return write([&]() -> StoreResult<void> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    for (const auto& [key, chunk] : chunks) {
      if (chunk->version <= head->version || chunk->version > range->last.version) {
        return refuse("keyframe_chunk chunk=" + text_of(key), "its version is not within the log");
      }
      if (auto saved = keyframes_.save(key, *chunk, meta_.chunk_edge); !saved) return saved;
    }
    if (!keyframe) return {};
    if (auto fits = check_keyframe(*keyframe, *range); !fits) {
      if (fits.error().may_pass()) return fits;
      return refuse(fits.error().where, fits.error().what);
    }
    const auto start = completed(*head);
    if (!start) return failed(start.error());
    const auto rows = keyframes_.rows(keyframe->at.version.seq);
    if (!rows) return failed(rows.error());
    if (auto proved = keyframes_.prove({*keyframe}, *start, *rows); !proved) {
      return refuse(proved.error().where, proved.error().what);
    }
    if (auto saved = keyframes_.save(*keyframe); !saved) return saved;
    return change_counts([](RowCounts& counts) { ++counts.keyframes; });
  });
}

}  // namespace runstone
