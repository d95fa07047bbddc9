// RecentChanges: the columns of chunks that the newest edits touched, so that a browser learns in
// one small answer which tiles changed.
// Thread: one.
#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// A column of chunks that an edit touched.
struct ChangedColumn {
  std::int32_t x = 0, z = 0;
  Sequence seq = 0;
  friend bool operator==(const ChangedColumn&, const ChangedColumn&) = default;
};

class RecentChanges {
 public:
  static constexpr std::size_t kKeptMax = 16'384;
  /// The number of columns in an answer.
  static constexpr std::size_t kAnswerMax = 1'024;

  /// Forgets everything. Edits up to `seq` are not known.
  void begin(Sequence seq);
  /// Adds the next edit of the log. Cost: O(chunks log chunks).
  void add(Sequence seq, std::span<const ChunkCoord> chunks);

  /// Returns the columns that edits after `since` touched, each with its newest edit. If there are
  /// too many, or if they are no longer known, is_complete is false and the list is empty.
  struct Answer {
    bool is_complete = false;
    std::vector<ChangedColumn> columns;  // ascending by x, then by z
  };
  Answer after(Sequence since) const;

 private:
  Sequence known_after_ = 0;  // all edits after it are in columns_
  std::deque<ChangedColumn> columns_;
};

}  // namespace runstone
