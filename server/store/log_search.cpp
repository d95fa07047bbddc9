#include "server/store/log_search.hpp"
#include "server/store/index_hint.hpp"
#include "server/store/sql_result.hpp"

#include <algorithm>

namespace runstone {
namespace {

// The edits that a statement finds at most. PostgreSQL returns all of them at once.
constexpr std::size_t kPortion = 65'536;

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
                                                std::optional<AuthorId> author) const {
  // The index is named, because the planner has no statistics, and a wrong index would read the
  // whole log.
  std::string text = query.wants
                         ? "SELECT seq, min_x, min_y, min_z, max_x, max_y, max_z FROM edit_log"
                         : "SELECT seq FROM edit_log";
  const bool by_cause = !author && query.cause && *query.cause != Cause::player;
  text += indexed_by(database_, author ? "edit_log_author" : by_cause ? "edit_log_cause" : nullptr);
  text += " WHERE log = 0 AND seq BETWEEN ?1 AND ?2";
  if (author) text += " AND author = ?3";
  if (query.cause) text += " AND cause = ?4";
  if (by_cause) text += " AND cause <> 0";  // the condition of the partial index
  if (query.box) {
    text +=
        " AND min_x < ?5 AND max_x > ?6 AND min_y < ?7 AND max_y > ?8 AND min_z < ?9 AND max_z > "
        "?10";
  }
  auto rows = database_.prepare(text + " ORDER BY seq LIMIT " + std::to_string(kPortion));
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

StoreResult<std::vector<Sequence>> LogSearch::in_segments(const LogQuery& query, Sequence first,
                                                          Sequence last) {
  std::vector<Sequence> found;
  const auto segments = segments_.find(query, first, last);
  if (!segments) return failed(segments.error());
  // The author of each segment is bound below, so the statement needs a condition on the author.
  auto rows = matching(query, query.author.value_or(0));
  if (!rows) return failed(rows.error());
  for (const LogSegment& segment : *segments) {
    rows->rewind();
    rows->bind(1, static_cast<std::int64_t>(std::max(first, segment.first)))
        .bind(2, static_cast<std::int64_t>(std::min(last, segment.last)))
        .bind(3, std::int64_t{segment.author});
    for (;;) {
      const auto more = rows->step();
      if (!more) return failed(more.error());
      if (!*more) break;
      if (query.wants && !query.wants(box_in(*rows, 1))) continue;
      found.push_back(static_cast<Sequence>(rows->integer(0)));
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

StoreResult<void> LogSearch::run(const LogQuery& query, const std::function<bool(Sequence)>& each) {
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
  if (query.box) {
    const auto found = in_segments(query, first, last);
    if (!found) return failed(found.error());
    for (const Sequence seq : *found) {
      if (!each(seq)) break;
    }
    return {};
  }
  auto rows = matching(query, query.author);
  if (!rows) return failed(rows.error());
  for (std::size_t found = kPortion; found == kPortion;) {
    rows->rewind();
    rows->bind(1, static_cast<std::int64_t>(first)).bind(2, static_cast<std::int64_t>(last));
    for (found = 0;; ++found) {
      const auto more = rows->step();
      if (!more) return failed(more.error());
      if (!*more) break;
      const auto seq = static_cast<Sequence>(rows->integer(0));
      if (!each(seq)) return {};
      first = seq + 1;
    }
  }
  return {};
}

}  // namespace runstone
