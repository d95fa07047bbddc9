// EditRecord: one entry of the edit log: author, time, place, cause and descriptor.
// docs/edit-log.md specifies its bytes.
#pragma once
#include <cstddef>
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

struct EditRecord {
  Version version;  // epoch and sequence; 1 <= seq <= kSequenceMax
  OperationId op;
  TimeUs time_us = 0;  // UTC; along the log it decreases only at a record that corrects_time()
  Cause cause = Cause::player;
  EditDescriptor edit;
  // The edit that this one reverts or restores (rollback, undo, redo), or the first edit of the
  // player's action that this one belongs to (player); below version.seq. 0: none.
  Sequence subject = 0;
  LogId log = 0;  // version.seq and subject count in this log
  friend bool operator==(const EditRecord&, const EditRecord&) = default;
};

inline constexpr std::uint8_t kEditRecordVersion = 1;
/// The maximum size of the descriptor in a record, with room for future kinds. decode_descriptor()
/// checks the maximum of each kind.
inline constexpr std::size_t kRecordDescriptorBytesMax = std::size_t{1} << 20;

/// Fails if sequence, client sequence or subject is outside its range, or if the cause is not that
/// of the edit: a change of rights has the cause `rights`, new materials have the cause
/// `materials`, a change of the library has the cause `library`, and no other edit has one of these.
Result<void> validate_fields(const EditRecord& record);

/// Returns true for a record that corrects the time of the log, or is the gap of one. Its time alone may be earlier than that
/// of the record before it. An *era* of the log begins at each such record; within an era times never
/// decrease.
bool corrects_time(const EditRecord& record);

/// Returns true for a record that gives a player a role for some time.
bool grants_for_some_time(const EditRecord& record);

/// Returns the canonical bytes without the checksum: version byte, numbers, bounding box,
/// descriptor. Requires validate_fields().
Bytes encode_record(const EditRecord& record);

/// Decodes a record. Fails if the bytes are not canonical or the bounding box is not that of the
/// descriptor.
Result<EditRecord> decode_record(ByteView in);
/// Returns the cause of a record from its bytes. Returns nullopt if they end before it or begin
/// with another version. The rest is not read. Cost: O(1).
std::optional<Cause> cause_of_record(ByteView in);

}  // namespace runstone
