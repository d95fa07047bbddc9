#include "server/store/segment_table.hpp"

#include <algorithm>
#include <utility>

#include "server/store/sql_result.hpp"

namespace runstone {
namespace {

constexpr std::size_t kOpenMax = 1024;  // authors with an open segment; bounds the memory

// A condition for PostgreSQL, which uses the index `log_box_space` for it. Its parameters are those
// of the box in find().
constexpr const char* kPostgresInBox =
    " AND int8range(min_x, max_x, '[]') && int8range(?5, ?4, '[]')"
    " AND int8range(min_y, max_y, '[]') && int8range(?7, ?6, '[]')"
    " AND int8range(min_z, max_z, '[]') && int8range(?9, ?8, '[]')";

bool is_small(const VoxelBox& box) {
  return std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}) <=
         kSegmentSide;
}

}  // namespace

StoreResult<SegmentTable> SegmentTable::open(sql::Database& database) {
  const std::string row =
      "INTO log_box(first_seq, min_x, max_x, min_y, max_y, min_z, max_z, last_seq, author) "
      "VALUES(?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)";
  // The virtual table of SQLite knows no ON CONFLICT.
  auto put = database.prepare(
      database.dialect() == sql::Dialect::sqlite
          ? "INSERT OR REPLACE " + row
          : "INSERT " + row +
                " ON CONFLICT(first_seq) DO UPDATE SET min_x = excluded.min_x, "
                "max_x = excluded.max_x, min_y = excluded.min_y, max_y = excluded.max_y, "
                "min_z = excluded.min_z, max_z = excluded.max_z, last_seq = excluded.last_seq, "
                "author = excluded.author");
  if (!put) return failed(put.error());
  return SegmentTable(database, *std::move(put));
}

StoreResult<void> SegmentTable::add(Sequence seq, AuthorId author, const VoxelBox& box) {
  if (open_.size() >= kOpenMax && !open_.contains(author)) {
    if (auto flushed = flush(); !flushed) return flushed;
    open_.clear();
  }
  Open& open = open_[author];
  if (open.edits > 0) {
    const VoxelBox joined = bounding_box(open.segment.box, box);
    if (open.edits < kSegmentEditsMin || (open.edits < kSegmentEditsMax && is_small(joined))) {
      open.segment.box = joined;
      open.segment.last = seq;
      ++open.edits;
      open.is_written = false;
      return {};
    }
    if (auto written = write(open); !written) return written;
  }
  open = {{seq, seq, author, box}, 1};
  return {};
}

StoreResult<void> SegmentTable::flush() {
  for (auto& [author, open] : open_) {
    if (auto written = write(open); !written) return written;
  }
  return {};
}

StoreResult<void> SegmentTable::write(Open& open) {
  if (open.is_written) return {};
  const LogSegment& segment = open.segment;
  open.is_written = true;
  if (!std::exchange(open.has_row, true)) ++added_;
  return store_result(put_.bind(1, static_cast<std::int64_t>(segment.first))
                          .bind(2, std::int64_t{segment.box.min.x})
                          .bind(3, std::int64_t{segment.box.max.x})
                          .bind(4, std::int64_t{segment.box.min.y})
                          .bind(5, std::int64_t{segment.box.max.y})
                          .bind(6, std::int64_t{segment.box.min.z})
                          .bind(7, std::int64_t{segment.box.max.z})
                          .bind(8, static_cast<std::int64_t>(segment.last))
                          .bind(9, std::int64_t{segment.author})
                          .run());
}

StoreResult<std::uint64_t> SegmentTable::remove_up_to(Sequence last) {
  // The R*Tree of SQLite would read all of its entries to find these. Its table of row ids has the
  // first sequence as the key, and in `a0` the first column that is no coordinate.
  const bool is_sqlite = database_->dialect() == sql::Dialect::sqlite;
  auto ending = database_->prepare(
      is_sqlite ? "SELECT rowid FROM log_box_rowid WHERE rowid <= ?1 AND a0 <= ?1"
                : "SELECT first_seq FROM log_box WHERE first_seq <= ?1 AND last_seq <= ?1");
  if (!ending) return failed(ending.error());
  ending->bind(1, static_cast<std::int64_t>(last));
  std::vector<std::int64_t> segments;
  for (;;) {
    const auto more = ending->step();
    if (!more) return failed(more.error());
    if (!*more) break;
    segments.push_back(ending->integer(0));
  }
  auto remove = database_->prepare("DELETE FROM log_box WHERE first_seq = ?1");
  if (!remove) return failed(remove.error());
  for (const std::int64_t first : segments) {
    if (auto removed = remove->bind(1, first).run(); !removed) return failed(removed.error());
  }
  std::erase_if(open_, [&](const auto& open) { return open.second.segment.last <= last; });
  return segments.size();
}

StoreResult<std::vector<LogSegment>> SegmentTable::find(const LogQuery& query, Sequence first,
                                                        Sequence last) {
  const std::optional<VoxelBox>& box = query.box;
  const std::optional<AuthorId> author = query.author;
  std::string text =
      "SELECT first_seq, last_seq, author, min_x, min_y, min_z, max_x, max_y, max_z FROM log_box "
      "WHERE first_seq <= ?1 AND last_seq >= ?2";
  if (author) text += " AND author = ?3";
  if (box)
    text +=
        " AND min_x < ?4 AND max_x > ?5 AND min_y < ?6 AND max_y > ?7 AND min_z < ?8 AND max_z > "
        "?9";
  if (box && database_->dialect() == sql::Dialect::postgres) text += kPostgresInBox;
  auto rows = database_->prepare(text);
  if (!rows) return failed(rows.error());
  rows->bind(1, static_cast<std::int64_t>(last)).bind(2, static_cast<std::int64_t>(first));
  if (author) rows->bind(3, std::int64_t{*author});
  if (box) {
    rows->bind(4, std::int64_t{box->max.x}).bind(5, std::int64_t{box->min.x});
    rows->bind(6, std::int64_t{box->max.y}).bind(7, std::int64_t{box->min.y});
    rows->bind(8, std::int64_t{box->max.z}).bind(9, std::int64_t{box->min.z});
  }
  std::vector<LogSegment> segments;
  for (;;) {
    const auto more = rows->step();
    if (!more) return failed(more.error());
    if (!*more) break;
    const VoxelBox around = box_in(*rows, 3);
    const auto end = static_cast<Sequence>(rows->integer(1));
    if (query.wants && !query.wants(around, end)) continue;
    segments.push_back({static_cast<Sequence>(rows->integer(0)), end,
                        static_cast<AuthorId>(rows->integer(2)), around});
  }
  std::sort(segments.begin(), segments.end(),
            [](const LogSegment& a, const LogSegment& b) { return a.first < b.first; });
  return segments;
}

}  // namespace runstone
