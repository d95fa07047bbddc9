// The part of SqlStore that counts rows: of the tables without a fold, of the base and of the log.
// docs/edit-log.md, "Row counts".
#include "server/store/loss_advice.hpp"
#include "server/store/sql_result.hpp"
#include "server/store/sql_store.hpp"

namespace runstone {
namespace {

constexpr const char* kSegments = "log_box";

std::string rows_missing(std::uint64_t found, std::uint64_t counted) {
  return std::to_string(counted - found) + " rows are missing: " + std::to_string(found) +
         " rows, meta counts " + std::to_string(counted) + ". " + kLossAdvice;
}

}  // namespace

StoreResult<std::uint64_t> SqlStore::count_of(const char* table) {
  const auto count = database().integer(std::string("SELECT count(*) FROM ") + table);
  if (!count) return failed(count.error());
  return static_cast<std::uint64_t>(*count);
}

StoreResult<RowCounts> SqlStore::counted_rows() {
  RowCounts counts;
  const auto names = count_of("player_name");
  if (!names) return failed(names.error());
  counts.player_names = *names;
  const auto keyframes = count_of("keyframe");
  if (!keyframes) return failed(keyframes.error());
  counts.keyframes = *keyframes;
  // The R*Tree of SQLite has a table with a row for each of its entries, which is counted faster.
  const bool is_sqlite = database().dialect() == sql::Dialect::sqlite;
  const auto segments = count_of(is_sqlite ? "log_box_rowid" : "log_box");
  if (!segments) return failed(segments.error());
  counts.segments = *segments;
  return counts;
}

StoreResult<void> SqlStore::put_epoch(Epoch epoch) {
  auto counts = meta_table_.row_counts();
  if (!counts) return failed(counts.error());
  if (!*counts) {
    const auto counted = counted_rows();
    if (!counted) return failed(counted.error());
    *counts = *counted;
  }
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  (*counts)->epoch = epoch;
  (*counts)->head = head->version.seq;
  if (auto put = meta_table_.put("epoch", std::int64_t{epoch}); !put) return put;
  if (auto put = put_counts(**counts); !put) return put;
  if (!is_open_) return {};
  return meta_table_.put_open_epoch(epoch);
}

StoreResult<void> SqlStore::put_counts(const RowCounts& counts) {
  counts_ = counts;
  return meta_table_.put_row_counts(counts);
}

StoreResult<void> SqlStore::change_counts(const std::function<void(RowCounts&)>& change) {
  if (!counts_) {
    const auto counts = meta_table_.row_counts();
    if (!counts) return failed(counts.error());
    counts_ = *counts;
  }
  if (!counts_) return {};  // the next start counts them
  RowCounts changed = *counts_;
  change(changed);
  return put_counts(changed);
}

StoreResult<void> SqlStore::flush_segments() {
  if (auto flushed = segments_.flush(); !flushed) return flushed;
  const std::uint64_t added = segments_.take_added();
  if (added == 0) return {};
  return change_counts([&](RowCounts& counts) { counts.segments += added; });
}

StoreResult<void> SqlStore::make_segments_again() {
  segments_.forget();
  if (auto gone = database().run("DELETE FROM log_box"); !gone) return failed(gone.error());
  // The rows are read in parts, so that no statement reads while another one writes. A gap in the
  // log does no harm.
  auto rows = database().prepare(
      "SELECT seq, author, min_x, min_y, min_z, max_x, max_y, max_z FROM edit_log "
      "WHERE log = 0 AND seq > ?1 ORDER BY seq LIMIT 4096");
  if (!rows) return failed(rows.error());
  std::vector<LogSegment> part;
  std::int64_t before = 0;
  do {
    part.clear();
    {
      const sql::ResetAtEnd reset_at_end(*rows);
      rows->bind(1, before);
      for (;;) {
        const auto more = rows->step();
        if (!more) return failed(more.error());
        if (!*more) break;
        before = rows->integer(0);
        const auto seq = static_cast<Sequence>(before);
        part.push_back({seq, seq, static_cast<AuthorId>(rows->integer(1)), box_in(*rows, 2)});
      }
    }
    for (const LogSegment& edit : part) {
      if (auto added = segments_.add(edit.first, edit.author, edit.box); !added) return added;
    }
  } while (!part.empty());
  if (auto flushed = segments_.flush(); !flushed) return flushed;
  segments_.forget();
  return {};
}

StoreResult<std::uint64_t> SqlStore::count_lost_edits() {
  if (database().dialect() != sql::Dialect::sqlite) return std::uint64_t{0};
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  const auto range = log_.range(*head);
  if (!range) return failed(range.error());
  const auto rows = count_of("edit_log");  // all are of log 0; SQLite counts in the smallest index
  if (!rows) return failed(rows.error());
  return range->last.version.seq + 1 - range->first - *rows;
}

StoreResult<void> SqlStore::check_base_count() {
  const auto fold = meta_table_.fold(base_.fold_key());
  if (!fold) return failed(fold.error());
  const auto rows = count_of("base");
  if (!rows) return failed(rows.error());
  if (*rows >= fold->count) return {};
  return failure(StoreError{
      StoreError::Kind::corrupt, file(), "base",
      rows_missing(*rows, fold->count) + ": the generator's ground then takes their place"});
}

StoreResult<StoreError> SqlStore::lost_edits_error(std::uint64_t lost) {
  const auto before = database().integer(
      "SELECT seq FROM edit_log AS here WHERE log = 0 AND NOT EXISTS (SELECT 1 FROM edit_log WHERE "
      "log = 0 AND seq = here.seq + 1) ORDER BY seq LIMIT 1");
  if (!before) return failed(before.error());
  return StoreError{
      StoreError::Kind::corrupt, file(), "edit_log seq=" + std::to_string(*before + 1),
      "is missing; the log lacks " + std::to_string(lost) + " edits in all. " + kLossAdvice +
          ": the present ground stays as the snapshots have it, and what needs these edits, such as "
          "the past and rollbacks of them, fails"};
}

StoreResult<std::vector<StoreError>> SqlStore::missing_rows() {
  const auto counts = meta_table_.row_counts();
  if (!counts) return failed(counts.error());
  const RowCounts expected = *counts ? **counts : RowCounts{};
  const auto found = counted_rows();
  if (!found) return failed(found.error());
  std::vector<StoreError> missing;
  const auto compare = [&](const char* table, std::uint64_t there, std::uint64_t counted) {
    if (there < counted)
      missing.push_back({StoreError::Kind::corrupt, file(), table, rows_missing(there, counted)});
  };
  compare("player_name", found->player_names, expected.player_names);
  compare("keyframe", found->keyframes, expected.keyframes);
  if (found->segments < expected.segments) {
    missing.push_back({StoreError::Kind::corrupt, file(), kSegments,
                       rows_missing(found->segments, expected.segments) +
                           ", which makes this index again from the log: no edit is lost"});
  }
  const auto lost = count_lost_edits();
  if (!lost) return failed(lost.error());
  if (*lost > expected.lost_edits) {
    const auto error = lost_edits_error(*lost);
    if (!error) return failed(error.error());
    missing.push_back(*error);
  }
  return missing;
}

StoreResult<void> SqlStore::check_counts() {
  return at_one_moment<void>([&]() -> StoreResult<void> {
    if (auto whole = check_base_count(); !whole) return whole;
    const auto missing = missing_rows();
    if (!missing) return failed(missing.error());
    if (!missing->empty()) return failure(missing->front());
    return {};
  });
}

StoreResult<void> SqlStore::accept_lost_counts(std::vector<std::string>& lost) {
  const auto missing = missing_rows();
  if (!missing) return failed(missing.error());
  if (missing->empty()) return {};
  for (const StoreError& error : *missing) {
    lost.push_back(error.message());
    if (error.where != kSegments) continue;
    if (auto made = make_segments_again(); !made) return made;
  }
  auto counts = counted_rows();
  if (!counts) return failed(counts.error());
  const auto lost_edits = count_lost_edits();
  if (!lost_edits) return failed(lost_edits.error());
  counts->lost_edits = *lost_edits;
  const auto epoch = meta_table_.counter("epoch");
  if (!epoch) return failed(epoch.error());
  counts->epoch = static_cast<Epoch>(*epoch);
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  counts->head = head->version.seq;
  return put_counts(*counts);
}

StoreResult<void> SqlStore::accept_lost_chunks(std::vector<std::string>& lost) {
  if (auto whole = check_base_count(); !whole) {
    if (whole.error().kind != StoreError::Kind::corrupt) return whole;
    lost.push_back(whole.error().message());
    const auto fold = base_.fold();
    if (!fold) return failed(fold.error());
    if (auto put = meta_table_.put_fold(base_.fold_key(), *fold); !put) return put;
  }
  const auto expected = meta_table_.fold(snapshots_.fold_key());
  if (!expected) return failed(expected.error());
  const auto found = snapshots_.fold();
  if (!found) return failed(found.error());
  if (*found == *expected) return {};
  lost.push_back(file() + ": snapshot: " + std::to_string(found->count) + " rows, meta counts " +
                 std::to_string(expected->count) +
                 ": the start makes them again from base and log, and no edit is lost");
  if (auto put = meta_table_.put_fold(snapshots_.fold_key(), *found); !put) return put;
  // The start puts all edits behind the checkpoint on the chunks that have no newer snapshot.
  const auto head = meta_table_.log_head();
  if (!head) return failed(head.error());
  return meta_table_.put("checkpoint", static_cast<std::int64_t>(head->version.seq));
}

}  // namespace runstone
