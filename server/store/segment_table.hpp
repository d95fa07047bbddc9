// SegmentTable: the index of edits by place, an R*Tree (`log_box`). An entry is a segment: a
// stretch of one author's edits and the box around them.
//   - A segment has up to kSegmentEditsMax edits and is up to kSegmentSide voxels wide. An edit
//     then costs a few bytes of index, and a search by place reads few rows in vain.
//   - A segment with fewer than kSegmentEditsMin edits also takes edits that lie far apart:
//     scattered edits must not cost an entry each.
//   - Segments of one author do not overlap in sequence. Every edit of the log lies in one.
// Threads: the one that owns the store.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/sql/database.hpp"
#include "server/store/log_reader.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

inline constexpr std::uint32_t kSegmentEditsMin = 6, kSegmentEditsMax = 64;
inline constexpr std::int32_t kSegmentSide = 64;

struct LogSegment {
  Sequence first = 0, last = 0;
  AuthorId author = 0;
  VoxelBox box;  // around the bounding boxes of its edits
};

/// Returns the box in the columns min_x, min_y, min_z, max_x, max_y, max_z of a row. `column` is the
/// first of them.
inline VoxelBox box_in(sql::Statement& row, int column) {
  const auto coordinate = [&](int i) { return static_cast<std::int32_t>(row.integer(column + i)); };
  return {{coordinate(0), coordinate(1), coordinate(2)},
          {coordinate(3), coordinate(4), coordinate(5)}};
}

class SegmentTable {
 public:
  /// The database must outlive the table.
  static StoreResult<SegmentTable> open(sql::Database& database);

  /// Adds an edit to the segment of its author, in the caller's transaction. flush() must be called
  /// before the commit.
  StoreResult<void> add(Sequence seq, AuthorId author, const VoxelBox& box);
  /// Writes the segments that have changed.
  StoreResult<void> flush();
  /// Drops all open segments. Call it after a transaction that was not committed. The next edit of
  /// each author begins a new segment, as after a start.
  void forget() {
    open_.clear();
    added_ = 0;
  }
  /// Deletes the segments that end at an edit up to `last`, in the caller's transaction, and
  /// returns how many rows there were. A segment that continues behind it stays, with a box that
  /// may be larger than needed.
  StoreResult<std::uint64_t> remove_up_to(Sequence last);
  /// Returns the number of rows that were added since the last call.
  std::uint64_t take_added() { return std::exchange(added_, 0); }

  /// Returns the segments that may hold edits of first..last that answer the query, by their first
  /// sequence. Only author, box and `wants` of the query count.
  StoreResult<std::vector<LogSegment>> find(const LogQuery& query, Sequence first, Sequence last);

 private:
  SegmentTable(sql::Database& database, sql::Statement put)
      : database_(&database), put_(std::move(put)) {}
  struct Open {
    LogSegment segment;
    std::uint32_t edits = 0;
    bool is_written = false;
    bool has_row = false;  // an older state of the segment was written
  };
  StoreResult<void> write(Open& open);

  sql::Database* database_;
  sql::Statement put_;
  std::map<AuthorId, Open> open_;
  std::uint64_t added_ = 0;  // rows
};

}  // namespace runstone
