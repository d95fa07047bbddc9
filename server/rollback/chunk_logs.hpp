// ChunkLogs: the edits of the log that touch a chunk, one chunk at a time. It can keep what it has read, for those
// who ask about the same chunk again and again. Blocks on the disk. One thread, which alone uses the reader.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "server/rollback/goes_on.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

class ChunkLogs {
 public:
  /// Keeps up to about `kept_bytes_max` bytes of records; a chunk whose log does not fit is read each time. The reader
  /// must outlive it.
  explicit ChunkLogs(LogReader& reader, GoesOn goes_on = {}, std::size_t kept_bytes_max = 0)
      : reader_(reader), goes_on_(std::move(goes_on)), kept_bytes_max_(kept_bytes_max) {}

  using Each = std::function<void(const EditRecord&)>;
  /// Calls `each` for the edits first..last (both included; none if first > last) that touch the chunk, ascending.
  /// Fails with what the store says, and with cancelled. The log up to `last` must be durable.
  StoreResult<void> visit(const ChunkKey& key, Sequence first, Sequence last, const Each& each);

 private:
  /// All edits of the chunk with sequences first..last.
  struct Kept {
    Sequence first = 1, last = 0;
    std::vector<EditRecord> records;
    bool is_too_large = false;
  };
  StoreResult<void> read(const ChunkKey& key, Sequence first, Sequence last, const Each& each);
  /// Widens what is kept until it holds first..last.
  StoreResult<void> keep(const ChunkKey& key, Kept& kept, Sequence first, Sequence last);

  LogReader& reader_;
  GoesOn goes_on_;
  std::size_t kept_bytes_max_;
  std::size_t kept_bytes_ = 0;
  std::map<ChunkKey, Kept> kept_;
};

}  // namespace runstone
