// SegmentTable: where edits are (R*Tree `log_box`). A segment is a stretch of one author's edits, up to
// kSegmentEditsMax of them and kSegmentSide voxels wide, so that an edit costs a few bytes of index and a search
// by place reads few rows in vain. Edits that lie far apart share one all the same while it has fewer than
// kSegmentEditsMin: scattered edits must not cost an entry each. Segments of one author do not overlap in sequence; every edit of the log
// lies in one. Belongs to the thread that owns the store.
#pragma once
#include <map>
#include <optional>
#include <vector>

#include "common/edits/descriptor/edit_record.hpp"
#include "common/sqlite/database.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

inline constexpr std::uint32_t kSegmentEditsMin = 6, kSegmentEditsMax = 64;
inline constexpr std::int32_t kSegmentSide = 64;

struct LogSegment {
  Sequence first = 0, last = 0;
  AuthorId author = 0;
  VoxelBox box;  // holds the bounding boxes of its edits
};

class SegmentTable {
 public:
  explicit SegmentTable(sql::Database& database) : database_(&database) {}

  /// Counts a record in. In the caller's transaction, as flush(), without which nothing is promised to be written.
  StoreResult<void> add(const EditRecord& record);
  StoreResult<void> flush();
  /// After a transaction that was not committed: forgets what was not written. The next edit of each author begins
  /// a segment, as after a start.
  void forget() { open_.clear(); }

  /// Segments that may hold such edits, by their first sequence.
  StoreResult<std::vector<LogSegment>> find(const std::optional<VoxelBox>& box,
                                            std::optional<AuthorId> author, Sequence first,
                                            Sequence last);

 private:
  struct Open {
    LogSegment segment;
    std::uint32_t edits = 0;
    bool is_written = false;
  };
  StoreResult<void> write(Open& open);

  sql::Database* database_;
  std::optional<sql::Statement>
      put_;  // prepared when first needed: a world of format 1 lacks the table
  std::map<AuthorId, Open> open_;
};

}  // namespace runstone
