// EditRecord: one entry of the edit log: who, when, where, why and what. docs/edit-log.md gives its bytes.
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
  TimeUs time_us = 0;  // UTC, never decreasing along the log
  Cause cause = Cause::player;
  EditDescriptor edit;
  Sequence subject = 0;  // the edit this one answers (rollback, undo, redo), < version.seq; 0: none
  LogId log = 0;         // version.seq and subject count in this log
  friend bool operator==(const EditRecord&, const EditRecord&) = default;
};

inline constexpr std::uint8_t kEditRecordVersion = 1;
/// What a record can carry: room for kinds yet to come, such as a pasted clipboard. Each kind's own bound is
/// decode_descriptor()'s.
inline constexpr std::size_t kRecordDescriptorBytesMax = std::size_t{1} << 20;

/// Names the first number that no record can have: sequence, client sequence or subject out of its range.
Result<void> validate_numbers(const EditRecord& record);

/// Canonical bytes without the checksum: version byte, then numbers, then the bounding box, then the
/// descriptor. Requires validate_numbers().
Bytes encode_record(const EditRecord& record);

/// The reverse; only canonical bytes pass, and the bounding box must be the descriptor's.
Result<EditRecord> decode_record(ByteView in);

}  // namespace runstone
