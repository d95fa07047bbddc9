// EditRecord: one entry of the edit log: who, when, where, why and what. docs/edit-log.md gives its bytes.
#pragma once
#include <cstdint>

#include "common/core/bytes.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "common/edits/edit_descriptor.hpp"

namespace runstone {

struct EditRecord {
  Version version;  // epoch and sequence; seq >= 1
  OperationId op;
  TimeUs time_us = 0;  // UTC, never decreasing along the log
  Cause cause = Cause::player;
  EditDescriptor edit;
  friend bool operator==(const EditRecord&, const EditRecord&) = default;
};

inline constexpr std::uint8_t kEditRecordVersion = 1;

/// Canonical bytes without the checksum: version byte, then varints, then the bounding box, then the
/// descriptor.
Bytes encode_record(const EditRecord& record);

/// The reverse; only canonical bytes pass, and the bounding box must be the descriptor's.
Result<EditRecord> decode_record(ByteView in);

/// XXH3-64 of encode_record(): stored beside the record, so that a damaged row is seen, never applied.
std::uint64_t record_checksum(const EditRecord& record);

}  // namespace runstone
