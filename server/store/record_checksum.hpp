// The checksum of a stored edit record.
#pragma once
#include <cstdint>

#include "common/edits/descriptor/edit_record.hpp"

namespace runstone {

/// Returns XXH3-64 of encode_record(record). It is stored beside the record, so that a damaged row
/// is rejected and never applied.
std::uint64_t record_checksum(const EditRecord& record);
/// Returns the checksum of the record with these bytes.
std::uint64_t record_checksum(ByteView bytes);

}  // namespace runstone
