// ChunkLogs: reads the edits of the log that touch a chunk, one chunk at a time. It can keep the
// records of a chunk, for a caller that reads the same chunk several times. It can also read the
// records of many chunks in one pass: scattered edits share an entry of the index by place, and a
// pass for each chunk would read all edits of the entry each time. It blocks on the disk.
// Threads: one, which alone uses the reader.
#pragma once
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/core/coords.hpp"
#include "server/rollback/should_continue.hpp"
#include "server/store/log_reader.hpp"

namespace runstone {

class ChunkLogs {
 public:
  /// Keeps up to about `kept_bytes_max` bytes of records. A chunk whose records do not fit is read
  /// from the disk each time. The reader must outlive the object.
  explicit ChunkLogs(LogReader& reader, ShouldContinue should_continue = {},
                     std::size_t kept_bytes_max = 0)
      : reader_(reader),
        should_continue_(std::move(should_continue)),
        kept_bytes_max_(kept_bytes_max) {}

  using Each = std::function<void(const EditRecord&)>;
  /// Calls `each` for the edits first..last (both included) that touch the chunk, ascending. There
  /// are none if first > last. Requires that the log is durable up to `last`. Fails as
  /// LogReader::query_log(), and with cancelled.
  StoreResult<void> visit(const ChunkKey& key, Sequence first, Sequence last, const Each& each);

  /// The edits of one chunk that visit() will be asked for: those from `first` on.
  struct Need {
    ChunkKey key;
    Sequence first = 1;
  };
  /// Reads the edits up to `last` that touch these chunks, in one pass. Until the next call, visit()
  /// of these chunks reads no disk. Returns false if the records take more than kAheadBytesMax:
  /// nothing is kept then, and visit() reads the disk. Fails as visit(). Cost: O(segments of the
  /// index around all of the chunks + edits of those that may touch one).
  StoreResult<bool> read_ahead(const std::vector<Need>& needs, Sequence last);
  /// Returns the edits that visit() would visit, or nullopt if it would read the disk. They live
  /// until the next call of read_ahead().
  std::optional<std::vector<const EditRecord*>> in_memory(const ChunkKey& key, Sequence first,
                                                          Sequence last) const;

 private:
  static constexpr std::size_t kAheadBytesMax = std::size_t{64} << 20;
  /// The records of read_ahead(). An edit may touch many chunks, so each chunk lists the places of its
  /// records.
  struct Ahead {
    struct ChunkRecords {
      Sequence first = 1;
      std::vector<std::size_t> records;  // places in `records`, ascending
    };
    Sequence last = 0;
    std::vector<EditRecord> records;
    std::map<ChunkKey, ChunkRecords> chunks;
  };
  /// All edits of a chunk with sequences first..last.
  struct Kept {
    Sequence first = 1, last = 0;
    std::vector<EditRecord> records;
    bool is_too_large = false;
  };
  StoreResult<void> read(const ChunkKey& key, Sequence first, Sequence last, const Each& each);
  /// Reads further records until `kept` covers first..last.
  StoreResult<void> keep(const ChunkKey& key, Kept& kept, Sequence first, Sequence last);

  LogReader& reader_;
  ShouldContinue should_continue_;
  std::size_t kept_bytes_max_;
  std::size_t kept_bytes_ = 0;
  std::map<ChunkKey, Kept> kept_;
  Ahead ahead_;
};

}  // namespace runstone
