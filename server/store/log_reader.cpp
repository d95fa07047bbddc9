#include "server/store/log_reader.hpp"

namespace runstone {

StoreResult<Sequence> LogReader::last_sequence() {
  const auto range = log_range();
  if (!range) return failure(range.error());
  return range->last.version.seq;
}

StoreResult<std::optional<LogEnd>> LogReader::edit_at(Sequence seq) {
  const auto head = log_head();
  if (!head) return failure(head.error());
  if (head->version.seq == seq) return std::optional(*head);
  std::optional<LogEnd> found;
  const auto read = read_log(seq, seq, [&](const EditRecord& record) {
    found = LogEnd{record.version, record.time_us};
    return false;
  });
  if (!read) return failure(read.error());
  return found;
}

}  // namespace runstone
