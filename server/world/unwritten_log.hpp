// UnwrittenLog: the parts of the log that the owner has sent to the log writer, and that may not be
// durable. A server that begins to follow gets them from here, and reads the others from the database.
// Bounds: the records are those of the log's queue. kUnwrittenRowsMax parts without records.
// Thread: the world strand.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

#include "protocol/codec/server_messages.hpp"

namespace runstone {

/// Nobody tells when rows without records are durable, until a record behind them is. They are written
/// within some 50 ms, so that the oldest of so many are.
inline constexpr std::size_t kUnwrittenRowsMax = 1'024;

class UnwrittenLog {
 public:
  /// Adds the next part.
  void add(LogPart part) {
    if (part.records.empty() && ++rows_ > kUnwrittenRowsMax) forget_first_rows();
    parts_.push_back(std::move(part));
  }
  /// Forgets what is durable: every record up to `seq`, and the rows before it.
  void durable(Sequence seq) {
    std::size_t rows = 0;  // parts without records in front of the next record
    for (;;) {
      while (rows < parts_.size() && parts_[rows].records.empty()) ++rows;
      if (rows == parts_.size() || parts_[rows].records.back().record.version.seq > seq) return;
      parts_.erase(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(rows) + 1);
      rows_ -= std::exchange(rows, 0);
    }
  }
  void clear() {
    parts_.clear();
    rows_ = 0;
  }
  /// Returns the parts in order. The first one may have records that are durable, too.
  const std::deque<LogPart>& parts() const { return parts_; }

 private:
  void forget_first_rows() {
    const auto first =
        std::ranges::find_if(parts_, [](const LogPart& part) { return part.records.empty(); });
    parts_.erase(first);
    --rows_;
  }

  std::deque<LogPart> parts_;
  std::size_t rows_ = 0;  // parts without records
};

}  // namespace runstone
