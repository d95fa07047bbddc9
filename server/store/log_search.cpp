#include "server/store/log_search.hpp"

#include <algorithm>
#include <map>

#include "server/store/index_hint.hpp"
#include "server/store/log_table.hpp"
#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

// The edits that a statement without a box finds at most. PostgreSQL returns all of them at once.
constexpr std::size_t kPortion = 4'096;
// Longer descriptors are not kept while edits are brought into order, and are read again.
constexpr std::size_t kKeptDescriptorMax = 64;

// Segments of one author that follow each other closely are read by one statement. A stretch is at
// most kStretchMax sequences long, which bounds the records that are kept.
constexpr Sequence kStretchMax = 1'024, kStretchGapMax = 64;
// A stretch with fewer sequences for each of its segments is read in the order of the log, together
// with the edits of other authors in it. That costs less than a look-up for each edit.
constexpr Sequence kDenseMax = 4 * kSegmentEditsMin;

/// The edits of one author in a part of the log.
struct Stretch {
  Sequence first = 0, last = 0;
  AuthorId author = 0;
  Sequence segments = 1;
  bool is_dense() const { return last - first < kDenseMax * segments; }
};

/// Joins segments to stretches, by their first sequence. Requires segments in that order.
std::vector<Stretch> stretches_of(const std::vector<LogSegment>& segments) {
  std::vector<Stretch> out;
  std::map<AuthorId, std::size_t> newest;  // place in `out`
  for (const LogSegment& segment : segments) {
    const auto found = newest.find(segment.author);
    if (found != newest.end()) {
      Stretch& before = out[found->second];
      if (segment.first <= before.last + kStretchGapMax &&
          segment.last - before.first < kStretchMax) {
        before.last = std::max(before.last, segment.last);
        ++before.segments;
        continue;
      }
    }
    newest[segment.author] = out.size();
    out.push_back({segment.first, segment.last, segment.author});
  }
  return out;
}

/// An edit that was found, but whose turn has not come.
struct FoundEdit {
  Sequence seq = 0;
  std::optional<EditRecord> record;  // nullopt: it is read later
};
bool is_later(const FoundEdit& a, const FoundEdit& b) { return a.seq > b.seq; }

}  // namespace

StoreResult<TimeUs> LogSearch::time_of(Sequence seq) {
  if (!time_) {
    auto prepared = database_.prepare("SELECT time_us FROM edit_log WHERE log = 0 AND seq = ?1");
    if (!prepared) return failed(prepared.error());
    time_ = *std::move(prepared);
  }
  const sql::ResetAtEnd reset_at_end(*time_);
  const auto row = time_->bind(1, static_cast<std::int64_t>(seq)).step();
  if (!row) return failed(row.error());
  if (!*row) {
    return failure(StoreError{StoreError::Kind::corrupt, database_.file(),
                              "edit_log seq=" + std::to_string(seq), "is missing"});
  }
  return time_->integer(0);
}

StoreResult<Sequence> LogSearch::first_behind(TimeUs time, Sequence first, Sequence last) {
  Sequence end = last + 1;
  while (first < end) {
    const Sequence middle = first + (end - first) / 2;
    const auto there = time_of(middle);
    if (!there) return failed(there.error());
    if (*there <= time) {
      first = middle + 1;
    } else {
      end = middle;
    }
  }
  return first;
}

StoreResult<std::optional<Sequence>> LogSearch::newest_at(TimeUs time) {
  Sequence last = range_.last.version.seq;
  // The first time of an era is its earliest one. If it is later, all edits of the era are later.
  for (auto era = eras_.rbegin(); era != eras_.rend() && era->first >= range_.first; ++era) {
    if (era->time_us <= time) {
      const auto behind = first_behind(time, era->first, last);
      if (!behind) return failed(behind.error());
      return std::optional(*behind - 1);
    }
    last = era->first - 1;
  }
  const auto behind = first_behind(time, range_.first, last);
  if (!behind) return failed(behind.error());
  if (*behind > range_.first) return std::optional(*behind - 1);
  if (head_.version.seq > 0 && head_.time_us <= time) return std::optional(head_.version.seq);
  return std::optional<Sequence>();
}

StoreResult<sql::Statement> LogSearch::matching(const LogQuery& query,
                                                std::optional<AuthorId> author, By by) const {
  const bool is_postgres = database_.dialect() == sql::Dialect::postgres;
  std::string columns = LogTable::kRecordColumns;
  if (is_postgres) {
    // It would send long descriptors even of edits that nobody wants.
    const std::string name = "descriptor";
    columns.replace(columns.find(name), name.size(),
                    "CASE WHEN length(descriptor) <= " + std::to_string(kKeptDescriptorMax) +
                        " THEN descriptor END");
  }
  // The index is named, because the planner has no statistics, and a wrong index would read the
  // whole log.
  const char* const index = by == By::author  ? "edit_log_author"
                            : by == By::cause ? "edit_log_cause"
                                              : nullptr;
  std::string text = "SELECT " + columns + " FROM edit_log" + indexed_by(database_, index);
  text += " WHERE log = 0 AND seq BETWEEN ?1 AND ?2";
  if (author) text += " AND author = ?3";
  if (query.cause) text += " AND cause = ?4";
  if (by == By::cause) text += " AND cause <> 0";  // the condition of the partial index
  if (query.box) {
    text +=
        " AND min_x < ?5 AND max_x > ?6 AND min_y < ?7 AND max_y > ?8 AND min_z < ?9 AND max_z > "
        "?10";
  }
  text += " ORDER BY seq";
  if (!query.box) text += " LIMIT " + std::to_string(kPortion);
  auto rows = database_.prepare(text);
  if (!rows) return failed(rows.error());
  if (author) rows->bind(3, std::int64_t{*author});
  if (query.cause) rows->bind(4, static_cast<std::int64_t>(*query.cause));
  if (query.box) {
    const VoxelBox& box = *query.box;
    rows->bind(5, std::int64_t{box.max.x}).bind(6, std::int64_t{box.min.x});
    rows->bind(7, std::int64_t{box.max.y}).bind(8, std::int64_t{box.min.y});
    rows->bind(9, std::int64_t{box.max.z}).bind(10, std::int64_t{box.min.z});
  }
  return *std::move(rows);
}

StoreResult<void> LogSearch::run_in_box(const LogQuery& query, Sequence first, Sequence last,
                                        const Each& each) {
  const auto segments = segments_.find(query, first, last);
  if (!segments) return failed(segments.error());
  // The author of each stretch is bound below, so the statements need a condition on the author.
  const AuthorId author = query.author.value_or(0);
  auto by_author = matching(query, author, By::author);
  if (!by_author) return failed(by_author.error());
  auto by_sequence = matching(query, author, By::sequence);
  if (!by_sequence) return failed(by_sequence.error());
  std::vector<FoundEdit> found;  // a heap; the earliest edit is at the front
  const auto pass_until = [&](Sequence end) {
    while (!found.empty() && found.front().seq < end) {
      std::pop_heap(found.begin(), found.end(), is_later);
      const FoundEdit edit = std::move(found.back());
      found.pop_back();
      if (!each(edit.seq, edit.record ? &*edit.record : nullptr)) return false;
    }
    return true;
  };
  for (const Stretch& stretch : stretches_of(*segments)) {
    // All edits that are not found yet have sequences from this one on.
    if (!pass_until(stretch.first)) return {};
    sql::Statement& rows = stretch.is_dense() ? *by_sequence : *by_author;
    rows.rewind();
    rows.bind(1, static_cast<std::int64_t>(std::max(first, stretch.first)))
        .bind(2, static_cast<std::int64_t>(std::min(last, stretch.last)))
        .bind(3, std::int64_t{stretch.author});
    for (;;) {
      const auto more = rows.step();
      if (!more) return failed(more.error());
      if (!*more) break;
      FoundEdit edit{static_cast<Sequence>(rows.integer(0)), std::nullopt};
      if (query.wants && !query.wants(box_in(rows, LogTable::kBoxColumn), edit.seq)) continue;
      if (rows.blob(LogTable::kDescriptorColumn).size() <= kKeptDescriptorMax)
        edit.record = LogTable::record_in(rows);
      found.push_back(std::move(edit));
      std::push_heap(found.begin(), found.end(), is_later);
    }
  }
  static_cast<void>(pass_until(last + 1));
  return {};
}

StoreResult<void> LogSearch::run(const LogQuery& query, const Each& each) {
  Sequence first = std::max(query.first, range_.first);
  Sequence last = std::min(query.last, range_.last.version.seq);
  if (first > last || query.from_us > query.until_us) return {};
  if (query.from_us != std::numeric_limits<TimeUs>::min()) {
    const auto before = newest_at(query.from_us - 1);
    if (!before) return failed(before.error());
    if (*before) first = std::max(first, **before + 1);
  }
  if (query.until_us != std::numeric_limits<TimeUs>::max()) {
    const auto until = newest_at(query.until_us);
    if (!until) return failed(until.error());
    last = std::min(last, until->value_or(0));
  }
  if (first > last) return {};
  if (query.box) return run_in_box(query, first, last, each);
  const bool by_cause = !query.author && query.cause && *query.cause != Cause::player;
  auto rows = matching(query, query.author,
                       query.author ? By::author
                       : by_cause   ? By::cause
                                    : By::sequence);
  if (!rows) return failed(rows.error());
  for (std::size_t found = kPortion; found == kPortion;) {
    rows->rewind();
    rows->bind(1, static_cast<std::int64_t>(first)).bind(2, static_cast<std::int64_t>(last));
    for (found = 0;; ++found) {
      const auto more = rows->step();
      if (!more) return failed(more.error());
      if (!*more) break;
      const auto seq = static_cast<Sequence>(rows->integer(0));
      const auto record = LogTable::record_in(*rows);
      if (!each(seq, record ? &*record : nullptr)) return {};
      first = seq + 1;
    }
  }
  return {};
}

}  // namespace runstone
