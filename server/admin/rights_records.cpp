#include "server/admin/rights_records.hpp"

#include "common/edits/descriptor/edit_descriptor.hpp"

namespace runstone {

StoreResult<std::vector<RightsRecord>> read_rights_records(LogReader& reader) {
  std::vector<RightsRecord> records;
  const auto read = reader.read_rights([&](const EditRecord& record) {
    if (const RightsChange* change = rights_change_of(record.edit))
      records.push_back({*change, {record.version.seq, record.op.author, record.time_us}});
    return true;
  });
  if (!read) return Unexpected<StoreError>{read.error()};
  return records;
}

}  // namespace runstone
