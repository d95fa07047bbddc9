// ReadSpan: joins the reads of a thread to transactions of a bounded number of reads, because a
// read in a transaction costs less (WorldReader::begin_reads()).
// Thread: that of the reader.
#pragma once
#include "server/store/world_reader.hpp"

namespace runstone {

class ReadSpan {
 public:
  /// `reader` must outlive the object.
  explicit ReadSpan(WorldReader& reader) : reader_(reader) {}
  ~ReadSpan() { static_cast<void>(end()); }
  ReadSpan(const ReadSpan&) = delete;
  ReadSpan& operator=(const ReadSpan&) = delete;

  /// Call it before each read. Fails as WorldReader::begin_reads().
  StoreResult<void> next() {
    if (reads_ == kReadsMax) {
      if (auto ended = end(); !ended) return ended;
    }
    if (reads_ == 0) {
      if (auto begun = reader_.begin_reads(); !begun) return begun;
    }
    ++reads_;
    return {};
  }

 private:
  static constexpr unsigned kReadsMax = 64;  // some milliseconds

  StoreResult<void> end() {
    if (reads_ == 0) return {};
    reads_ = 0;
    return reader_.end_reads();
  }

  WorldReader& reader_;
  unsigned reads_ = 0;  // of the span that is open; 0: none is
};

}  // namespace runstone
