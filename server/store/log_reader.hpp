// LogReader: reading of the edit log.
// A compaction moves the beginning of the log: edits before it are in the base alone.
#pragma once
#include <functional>
#include <limits>
#include <optional>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/edits/descriptor/edit_record.hpp"
#include "server/store/store_error.hpp"
#include "server/store/world_info.hpp"

namespace runstone {

/// A place in the log. It is version (0, 0) and time 0 before the first edit.
struct LogEnd {
  Version version;
  TimeUs time_us = 0;  // UTC, of that edit
  friend bool operator==(const LogEnd&, const LogEnd&) = default;
};

/// The extent of the log: the edits first .. last.version.seq. It is empty if `first` is greater.
struct LogRange {
  Sequence first = 1;
  LogEnd last;  // the last edit ever ordered, compacted or not
  friend bool operator==(const LogRange&, const LogRange&) = default;
};

/// The start of an era: a record that corrects_time().
struct LogEra {
  Sequence first = 0;
  TimeUs time_us = 0;  // UTC, of that record
  friend bool operator==(const LogEra&, const LogEra&) = default;
};

/// Conditions on edits of the log: author, time, place and cause. A condition that is not set holds
/// for every edit. The times stand for places in the log (LogReader::sequence_at()). If a record
/// corrects the time, an edit between these places may have a time that is not between them.
struct LogQuery {
  std::optional<AuthorId> author;
  // UTC. Holds for the edits behind the newest edit whose time is earlier.
  TimeUs from_us = std::numeric_limits<TimeUs>::min();
  // UTC. Holds for the edits up to the newest edit whose time is not later.
  TimeUs until_us = std::numeric_limits<TimeUs>::max();
  std::optional<VoxelBox> box;  // not empty; overlaps the bounding box of the edit
  /// Called only if `box` is set. Its arguments are the bounding box and the sequence of one edit, or
  /// a box that holds the bounding boxes of several edits, and the last sequence of them. If it
  /// returns false, the query leaves out these edits and does not read them. It must then also return
  /// false for each of them alone. An empty function leaves out no edit.
  std::function<bool(const VoxelBox& box, Sequence last)> wants;
  std::optional<Cause> cause;
  Sequence first = 1, last = kSequenceMax;  // both included
};

/// A record of the log without its edit.
struct LogRow {
  Version version;
  OperationId op;
  Cause cause = Cause::player;
  Sequence subject = 0;
  friend bool operator==(const LogRow&, const LogRow&) = default;
};

class LogReader : public virtual WorldInfo {
 public:
  using EachRecord = std::function<bool(const EditRecord&)>;
  using EachRow = std::function<bool(const LogRow&)>;

  /// Returns the extent of the log. All of it is durable.
  virtual StoreResult<LogRange> log_range() = 0;
  /// Returns the last edit that was compacted away; the log begins after it. It is (0, 0) and 0 if
  /// there is none.
  virtual StoreResult<LogEnd> log_head() = 0;
  /// Returns the last sequence ever logged, compacted or not, or 0 if there is none.
  StoreResult<Sequence> last_sequence();
  /// Returns sequence, epoch and time of an edit, or nullopt if the log does not have it. The edit
  /// 0 is the state before the first one; an empty log has it.
  StoreResult<std::optional<LogEnd>> edit_at(Sequence seq);
  /// Returns the newest edit whose time is not later than `time_us` (UTC). If all edits are later,
  /// returns the sequence before the first edit of the log. Fails (bad_request) if all are later and
  /// one of them was compacted away. Cost: O(eras + log edits).
  virtual StoreResult<Sequence> sequence_at(TimeUs time_us) = 0;
  /// Calls `each` for the records first..last (both included) in order, until it returns false.
  /// Records outside log_range() are left out. Each checksum is verified, and so is that no
  /// sequence is missing.
  virtual StoreResult<void> read_log(Sequence first, Sequence last, const EachRecord& each) = 0;
  /// Calls `each` for the records that answer the query, in order, until it returns false.
  virtual StoreResult<void> query_log(const LogQuery& query, const EachRecord& each) = 0;
  /// Calls `each` for the records of an author up to `last`, the newest first, until it returns false.
  /// It reads neither edits nor checksums, so it serves to find records: whoever acts by one reads it
  /// with read_log() or query_log(). Cost: O(log edits) for each.
  virtual StoreResult<void> rows_of_author(AuthorId author, Sequence last, const EachRow& each) = 0;
  /// Calls `each` for all changes of rights, in order, until it returns false. They include those
  /// that a compaction moved out of the log.
  virtual StoreResult<void> read_rights(const EachRecord& each) = 0;
  /// Calls `each` for all records that give textures, in order, until it returns false. They
  /// include those that a compaction moved out of the log.
  virtual StoreResult<void> read_textures(const EachRecord& each) = 0;
  /// Returns the material table after edit `at`: meta().materials, and the rows that records of the
  /// log added. Fails (corrupt) if a record does not continue the table.
  virtual StoreResult<MaterialTable> materials(Sequence at) = 0;
  /// Returns the material table in force.
  StoreResult<MaterialTable> materials() { return materials(kSequenceMax); }
};

}  // namespace runstone
