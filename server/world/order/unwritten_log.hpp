// UnwrittenLog: the parts of the log that the owner has sent to the log writer, and that may not be
// durable. A server that begins to follow gets them from here, and reads the others from the
// database. Bounds: the records are those of the log's queue, and their memory is counted as theirs
// is (WorldMemory). kUnwrittenRowsMax parts without records.
// Thread: the world strand.
#pragma once
#include <algorithm>
#include <cstddef>
#include <deque>
#include <utility>

#include "common/edits/descriptor/edit_memory.hpp"
#include "protocol/codec/server_messages.hpp"

namespace runstone {

/// Rows without records are known to be durable when a later record is. They are written within
/// some 50 ms, so of this many the oldest ones are written.
inline constexpr std::size_t kUnwrittenRowsMax = 1'024;

class UnwrittenLog {
 public:
  /// Adds the next part.
  void add(LogPart part) {
    if (part.records.empty() && ++rows_ > kUnwrittenRowsMax) forget_first_rows();
    bytes_ += bytes_of(part);
    parts_.push_back(std::move(part));
  }
  /// Forgets what is durable: every record up to `seq`, and the rows before it.
  void durable(Sequence seq) {
    std::size_t rows = 0;  // parts without records in front of the next record
    for (;;) {
      while (rows < parts_.size() && parts_[rows].records.empty()) ++rows;
      if (rows == parts_.size() || parts_[rows].records.back().record.version.seq > seq) return;
      for (std::size_t i = 0; i <= rows; ++i) {
        bytes_ -= bytes_of(parts_.front());
        parts_.pop_front();
      }
      rows_ -= std::exchange(rows, 0);
    }
  }
  void clear() {
    parts_.clear();
    rows_ = bytes_ = 0;
  }
  /// Returns the parts in order. The first one may have records that are durable, too.
  const std::deque<LogPart>& parts() const { return parts_; }
  /// Returns the bytes of memory that the parts take.
  std::size_t bytes() const { return bytes_; }

 private:
  static std::size_t bytes_of(const LogPart& part) {
    std::size_t bytes = sizeof(LogPart) + part.players.size() * sizeof(LogPlayer) +
                        part.names.size() * sizeof(LogName);
    for (const LogPartRecord& one : part.records)
      bytes += sizeof(LogPartRecord) + memory_bytes(one.record.edit);
    return bytes;
  }
  void forget_first_rows() {
    const auto first =
        std::ranges::find_if(parts_, [](const LogPart& part) { return part.records.empty(); });
    bytes_ -= bytes_of(*first);
    parts_.erase(first);
    --rows_;
  }

  std::deque<LogPart> parts_;
  std::size_t rows_ = 0;  // parts without records
  std::size_t bytes_ = 0;
};

}  // namespace runstone
