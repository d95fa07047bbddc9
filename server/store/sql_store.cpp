#include "server/store/sql_store.hpp"
#include "common/sql/transaction.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "common/core/epoch_branch.hpp"
#include "common/core/key_text.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "server/store/log_search.hpp"
#include "server/store/removed_history.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/world_schema.hpp"

namespace runstone {

SqlStore::SqlStore(std::unique_ptr<WorldBackend> backend, StoreAccess access, Tables tables,
                   WorldMeta meta)
    : backend_(std::move(backend)),
      meta_table_(std::move(tables.meta)),
      player_table_(std::move(tables.players)),
      names_(std::move(tables.names)),
      claims_(std::move(tables.claims)),
      kept_(std::move(tables.kept)),
      log_(std::move(tables.log)),
      segments_(std::move(tables.segments)),
      base_(std::move(tables.base)),
      snapshots_(std::move(tables.snapshots)),
      keyframes_(std::move(tables.keyframes)),
      tiles_(std::move(tables.tiles)),
      access_(access),
      meta_(std::move(meta)) {}

Unexpected<StoreError> SqlStore::refuse(std::string where, std::string what) const {
  return {{StoreError::Kind::bad_request, file(), std::move(where), std::move(what)}};
}

StoreResult<void> SqlStore::write(const std::function<StoreResult<void>()>& body) {
  if (auto begun = begin_writing(); !begun) return begun;
  return transact(body);
}

StoreResult<void> SqlStore::transact(const std::function<StoreResult<void>()>& body) {
  if (access_ == StoreAccess::read_only) return refuse("", "is open for reading only");
  if (broken_) {
    return failure(StoreError{StoreError::Kind::io, file(), "",
                              "an earlier commit failed; open the world again"});
  }
  auto transaction = sql::Transaction::begin(database());
  if (!transaction) return failed(transaction.error());
  auto done = body();
  // At the end, so that a long transaction does not keep the lease from being renewed.
  if (done) done = backend_->confirm_ownership();
  if (done) done = store_result(database().flush());
  if (!done) {
    forget_uncommitted();
    return done;
  }
  auto committed = store_result(transaction->commit());
  if (!committed) {
    forget_uncommitted();
    // A full disk fails a write to the WAL, before the fsync. SQLite knows then that nothing was
    // committed, and the next transaction overwrites what was written. A database that takes no
    // writes has rolled the transaction back.
    broken_ = !can_be_repeated(committed.error());
    return committed;
  }
  is_library_new_ = false;
  if (std::exchange(is_format_raised_, false)) {
    // An older program looks for the number in the main file alone, before it opens the database.
    const auto completed = backend_->complete_file(false);
    if (!completed || !*completed) is_reader_in_the_way_ = true;
  }
  return committed;
}

StoreResult<void> SqlStore::publish_address(const std::string& address) {
  if (access_ == StoreAccess::read_only) return refuse("", "is open for reading only");
  return backend_->publish_address(address);
}

void SqlStore::committed(const DurableState& state) {
  state_ = state;
  static_cast<void>(backend_->write_mark(state).has_value());
}

StoreResult<Epoch> SqlStore::raise_epoch() { return set_epoch(state_.epoch + 1); }

StoreResult<Epoch> SqlStore::begin_branch(TimeUs now_us) {
  return set_epoch(next_branch(state_.epoch, now_us));
}

StoreResult<Epoch> SqlStore::set_epoch(Epoch epoch) {
  DurableState next = state_;
  next.epoch = epoch;
  const auto written = transact([&]() -> StoreResult<void> {
    if (library_) {
      auto parts = meta_table_.fold(kBuildPartFoldKey);
      if (!parts) return failed(parts.error());
      if (auto removed = library_->remove_unused_parts(*parts); !removed) return removed;
      if (auto put = meta_table_.put_fold(kBuildPartFoldKey, *parts); !put) return put;
    }
    return put_epoch(next.epoch);
  });
  if (!written) return failed(written.error());
  state_ = next;
  // A world whose mark cannot be written is not started.
  if (auto marked = backend_->write_mark(next); !marked) return failed(marked.error());
  if (auto synced = backend_->sync_mark(); !synced) return failed(synced.error());
  has_mark_file_ = is_whole_ = true;
  return next.epoch;
}

StoreResult<LogRange> SqlStore::log_range() {
  return at_one_moment<LogRange>([&]() -> StoreResult<LogRange> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    return log_.range(*head);
  });
}

StoreResult<Sequence> SqlStore::checkpoint() {
  // A running server moves checkpoint and head.
  return at_one_moment<Sequence>([&]() -> StoreResult<Sequence> {
    const auto checkpoint = meta_table_.counter("checkpoint");
    if (!checkpoint) return checkpoint;
    const auto range = log_range();
    if (!range) return failed(range.error());
    const Sequence last = range->last.version.seq;
    if (*checkpoint <= last && *checkpoint + 1 >= range->first) return checkpoint;
    const std::string log = *checkpoint > last
                                ? "ends at seq=" + std::to_string(last) + ", before"
                                : "begins at seq=" + std::to_string(range->first) + ", behind";
    return failure(StoreError{StoreError::Kind::corrupt, file(), "edit_log",
                              log + " the checkpoint seq=" + std::to_string(*checkpoint)});
  });
}

StoreResult<LogEnd> SqlStore::log_head() { return meta_table_.log_head(); }

StoreResult<bool> SqlStore::has_base() {
  const auto fold = meta_table_.fold(base_.fold_key());
  if (!fold) return failed(fold.error());
  return fold->count != 0;
}

StoreResult<void> SqlStore::check_continues(std::span<const EditRecord> records, bool history) {
  const auto range = log_range();
  if (!range) return failed(range.error());
  Sequence expected = range->last.version.seq;
  Epoch epoch = range->last.version.epoch;
  for (const EditRecord& record : records) {
    ++expected;
    const std::string where = "edit_log seq=" + std::to_string(record.version.seq);
    if (record.version.seq != expected)
      return refuse(where, "the log continues at " + std::to_string(expected));
    if (history ? record.version.epoch < epoch : record.version.epoch != state_.epoch) {
      return refuse(where, "the epoch is " + std::to_string(history ? epoch : state_.epoch));
    }
    epoch = record.version.epoch;
    if (record.log != 0) return refuse(where, "belongs to another log");
    if (const auto numbers = validate_fields(record); !numbers)
      return refuse(where, numbers.error().what);
  }
  return check_continues_materials(records);
}

StoreResult<void> SqlStore::append(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records) {
  DurableState next;
  auto written = write([&]() -> StoreResult<void> {
    if (auto continues = check_continues(records, false); !continues) return continues;
    return insert(players, records, false, next);
  });
  if (written) committed(next);
  return written;
}

StoreResult<void> SqlStore::append_history(std::span<const PlayerRow> players,
                                           std::span<const EditRecord> records) {
  DurableState next;
  auto written = write([&]() -> StoreResult<void> {
    if (auto continues = check_continues(records, true); !continues) return continues;
    if (auto inserted = insert(players, records, true, next); !inserted) return inserted;
    if (!records.empty()) next.epoch = std::max(next.epoch, records.back().version.epoch);
    return put_epoch(next.epoch);
  });
  if (written) committed(next);
  return written;
}

StoreResult<void> SqlStore::insert(std::span<const PlayerRow> players,
                                   std::span<const EditRecord> records, bool is_history,
                                   DurableState& next) {
  next = state_;
  if (auto put = put_players(players); !put) return put;
  for (const PlayerRow& player : players)
    next.author_max = std::max(next.author_max, player.author);
  Watermarks marks;
  if (auto marked = mark_shapes(records); !marked) return marked;
  if (auto inserted = log_.insert(records); !inserted) return inserted;
  for (const EditRecord& record : records) {
    auto added = segments_.add(record.version.seq, record.op.author, bounding_box(record.edit));
    if (!added) return added;
    raise(marks, record);
    next.author_max = std::max(next.author_max, record.op.author);
    next.seq = record.version.seq;
  }
  if (auto added = add_eras(records); !added) return added;
  if (auto applied = apply_library(records, is_history); !applied) return applied;
  if (auto marked = mark_textures(records); !marked) return marked;
  if (auto marked = mark_gaps(records); !marked) return marked;
  if (auto marked = mark_timed_grants(records); !marked) return marked;
  if (auto set = set_clock(records); !set) return set;
  if (auto raised = raise_watermarks(marks); !raised) return raised;
  if (auto put = meta_table_.put("log_last", static_cast<std::int64_t>(next.seq)); !put) return put;
  const auto author_max = meta_table_.counter("author_max");
  if (!author_max) return failed(author_max.error());
  if (*author_max != next.author_max) {
    if (auto put = meta_table_.put("author_max", std::int64_t{next.author_max}); !put) return put;
  }
  return flush_segments();
}

StoreResult<void> SqlStore::add_eras(std::span<const EditRecord> records) {
  std::vector<LogEra> added;
  for (const EditRecord& record : records) {
    if (corrects_time(record)) added.push_back({record.version.seq, record.time_us});
  }
  if (added.empty()) return {};
  auto eras = meta_table_.log_eras();
  if (!eras) return failed(eras.error());
  eras->insert(eras->end(), added.begin(), added.end());
  if (auto put = meta_table_.put_log_eras(*eras); !put) return put;
  return raise_format(kWorldFormatOfEras);
}

StoreResult<void> SqlStore::mark_gaps(std::span<const EditRecord> records) {
  const bool has_gaps = std::ranges::any_of(
      records, [](const EditRecord& record) { return gap_of(record.edit) != nullptr; });
  if (!has_gaps) return {};
  if (auto put = meta_table_.put(kGapsKey, std::int64_t{1}); !put) return put;
  return raise_format(kWorldFormatOfGaps);
}

StoreResult<void> SqlStore::mark_timed_grants(std::span<const EditRecord> records) {
  if (std::ranges::none_of(records, grants_for_some_time)) return {};
  if (auto put = meta_table_.put(kTimedGrantsKey, std::int64_t{1}); !put) return put;
  return raise_format(kWorldFormatOfTimedGrants);
}

StoreResult<void> SqlStore::raise_format(std::uint32_t format) {
  const auto present = backend_->format();
  if (!present) return failed(present.error());
  if (*present >= format) return {};
  if (auto set = backend_->set_format(format); !set) return set;
  is_format_raised_ = true;
  return {};
}

StoreResult<void> SqlStore::save_chunks(ChunkTable& table, ChunkSpan chunks) {
  if (chunks.empty()) return {};
  auto fold = meta_table_.fold(table.fold_key());
  if (!fold) return failed(fold.error());
  for (const auto& [key, chunk] : chunks) {
    if (auto saved = table.save(key, *chunk, meta_.chunk_edge, *fold); !saved) return saved;
  }
  return meta_table_.put_fold(table.fold_key(), *fold);
}

StoreResult<void> SqlStore::save_snapshots(ChunkSpan chunks, std::optional<Sequence> checkpoint) {
  auto written = write([&]() -> StoreResult<void> {
    const auto range = log_range();
    if (!range) return failed(range.error());
    const Version durable = range->last.version;
    for (const auto& [key, chunk] : chunks) {
      if (chunk->version > durable) {
        return refuse("snapshot chunk=" + text_of(key), "its version is not durable yet");
      }
    }
    if (auto saved = save_chunks(snapshots_, chunks); !saved) return saved;
    std::vector<std::pair<ChunkKey, Version>> versions;
    versions.reserve(chunks.size());
    for (const auto& [key, chunk] : chunks) versions.emplace_back(key, chunk->version);
    if (auto removed = tiles_->remove_stale(versions); !removed) return removed;
    if (!checkpoint) return {};
    const auto before = meta_table_.counter("checkpoint");
    if (!before) return failed(before.error());
    if (*checkpoint > durable.seq) return refuse("meta key=checkpoint", "is ahead of the log");
    if (*checkpoint < *before) return refuse("meta key=checkpoint", "may not move back");
    return meta_table_.put("checkpoint", static_cast<std::int64_t>(*checkpoint));
  });
  if (written && checkpoint) {
    // A mark that cannot be synced may lag after a power failure.
    static_cast<void>(backend_->sync_mark().has_value());
    if (is_reader_in_the_way_) {
      const auto completed = backend_->complete_file(false);
      is_reader_in_the_way_ = !completed || !*completed;
    }
  }
  return written;
}

StoreResult<void> SqlStore::save_base(ChunkSpan chunks) {
  return write([&]() -> StoreResult<void> {
    const auto last = last_sequence();
    if (!last) return failed(last.error());
    if (*last != 0) return refuse("base", "cannot change once the log has edits");
    for (const auto& [key, chunk] : chunks) {
      if (chunk->version != Version{})
        return refuse("base chunk=" + text_of(key), "base chunks stand at version (0, 0)");
    }
    if (auto cleared = tiles_->clear(); !cleared) return cleared;
    return save_chunks(base_, chunks);
  });
}

StoreResult<void> SqlStore::save_tiles(ChunkSpan tiles, std::uint32_t rules) {
  return write([&]() -> StoreResult<void> {
    const auto range = log_range();
    if (!range) return failed(range.error());
    const auto present = meta_table_.counter("tile_rules");
    if (!present) return failed(present.error());
    if (*present != rules) return {};
    for (const auto& [key, tile] : tiles) {
      // An edit that a crash takes away must not stay in a tile.
      if (tile->version > range->last.version)
        return refuse("tile chunk=" + text_of(key), "its version is not durable yet");
      if (auto saved = tiles_->save(key, *tile, meta_.chunk_edge); !saved) return saved;
    }
    return {};
  });
}

StoreResult<void> SqlStore::begin_reads() {
  if (const auto begun = database().begin_reads(); !begun) return failed(begun.error());
  return {};
}

StoreResult<void> SqlStore::end_reads() {
  if (const auto ended = database().end_reads(); !ended) return failed(ended.error());
  return {};
}

StoreResult<std::optional<Chunk>> SqlStore::load_tile(const ChunkKey& key, std::uint32_t rules) {
  if (!tiles_) return std::optional<Chunk>();
  return tiles_->load(key, rules, meta_.chunk_edge, row_check_);
}

StoreResult<std::vector<std::pair<ChunkKey, Version>>> SqlStore::tile_keys(std::uint32_t rules) {
  if (!tiles_) return std::vector<std::pair<ChunkKey, Version>>();
  return tiles_->keys(rules);
}

StoreResult<std::vector<std::string>> SqlStore::rows_of_no_tile() {
  if (!tiles_) return std::vector<std::string>();
  return tiles_->rows_of_no_tile();
}

StoreResult<std::optional<Chunk>> SqlStore::load_snapshot(const ChunkKey& key, Sequence last) {
  return snapshots_.load(key, last, meta_.chunk_edge, row_check_);
}

StoreResult<std::optional<Chunk>> SqlStore::load_base(const ChunkKey& key) {
  return base_.load(key, kSequenceMax, meta_.chunk_edge, row_check_);
}

StoreResult<std::vector<ChunkKey>> SqlStore::chunk_keys(ChunkRows rows,
                                                        const std::optional<ChunkKey>& behind,
                                                        std::size_t count) {
  return (rows == ChunkRows::base ? base_ : snapshots_).keys(database(), behind, count);
}

StoreResult<void> SqlStore::read_log(Sequence first, Sequence last, const EachRecord& each) {
  // A running server may remove the beginning of the log between two statements.
  return at_one_moment<void>([&]() -> StoreResult<void> {
    const auto range = log_range();
    if (!range) return failed(range.error());
    return log_.read(*range, first, last, each);
  });
}

StoreResult<void> SqlStore::query_log(const LogQuery& query, const EachRecord& each) {
  return at_one_moment<void>([&]() -> StoreResult<void> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    auto eras = meta_table_.log_eras();
    if (!eras) return failed(eras.error());
    auto reader = log_.reader();
    if (!reader) return failed(reader.error());
    StoreResult<void> read;
    LogSearch search(database(), segments_, *head, *range, *std::move(eras));
    auto searched = search.run(query, [&](Sequence seq, const EditRecord* found) {
      if (found != nullptr) return each(*found);
      const auto record = log_.read_one(*reader, seq);
      if (!record) read = failed(record.error());
      return record.has_value() && each(*record);
    });
    return read ? searched : read;
  });
}

StoreResult<void> SqlStore::rows_of_author(AuthorId author, Sequence last, const EachRow& each) {
  return at_one_moment<void>([&]() -> StoreResult<void> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    return log_.rows_of_author(*range, author, last, each);
  });
}

StoreResult<Sequence> SqlStore::sequence_at(TimeUs time_us) {
  return at_one_moment<Sequence>([&]() -> StoreResult<Sequence> {
    const auto head = meta_table_.log_head();
    if (!head) return failed(head.error());
    const auto range = log_.range(*head);
    if (!range) return failed(range.error());
    if (range->last.time_us <= time_us) return range->last.version.seq;
    auto eras = meta_table_.log_eras();
    if (!eras) return failed(eras.error());
    const auto found =
        LogSearch(database(), segments_, *head, *range, *std::move(eras)).newest_at(time_us);
    if (!found) return failed(found.error());
    if (*found) return **found;
    if (head->version.seq == 0) return range->first - 1;
    return refuse("edit_log", "begins at seq=" + std::to_string(range->first) +
                                  ": what was before that time was " + removed_up_to(*head));
  });
}

StoreResult<std::vector<StoredChunk>> SqlStore::rows_of(ChunkTable& table) {
  return at_one_moment<std::vector<StoredChunk>>([&]() -> StoreResult<std::vector<StoredChunk>> {
    const auto fold = meta_table_.fold(table.fold_key());
    if (!fold) return failed(fold.error());
    return table.rows(*fold);
  });
}

StoreResult<std::vector<std::pair<ChunkKey, Version>>> SqlStore::snapshot_keys() {
  const auto rows = rows_of(snapshots_);
  if (!rows) return failed(rows.error());
  std::vector<std::pair<ChunkKey, Version>> keys;
  keys.reserve(rows->size());
  for (const StoredChunk& row : *rows) keys.emplace_back(row.key, row.version);
  return keys;
}

}  // namespace runstone
