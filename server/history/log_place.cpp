#include "server/history/log_place.hpp"

namespace runstone {

StoreResult<LogEnd> edit_at(Store& reader, Sequence seq) {
  const auto head = reader.log_head();
  if (!head) return head;
  if (seq == head->version.seq) return head;
  std::optional<LogEnd> found;
  const auto read = reader.read_log(seq, seq, [&](const EditRecord& record) {
    found = LogEnd{record.version, record.time_us};
    return true;
  });
  if (!read) return Unexpected<StoreError>{read.error()};
  if (found) return *found;
  const auto range = reader.log_range();
  if (!range) return Unexpected<StoreError>{range.error()};
  return Unexpected<StoreError>{{StoreError::Kind::bad_request, reader.file(), "edit_log",
                                 "holds seq=" + std::to_string(head->version.seq) +
                                     " to seq=" + std::to_string(range->last.version.seq) +
                                     ", not seq=" + std::to_string(seq)}};
}

StoreResult<LogEnd> last_edit_at(Store& reader, TimeUs utc_us) {
  const auto range = reader.log_range();
  if (!range) return Unexpected<StoreError>{range.error()};
  Sequence low = range->first - 1, high = range->last.version.seq;  // the one sought lies in low .. high
  while (low < high) {
    const Sequence middle = low + (high - low + 1) / 2;
    const auto at = edit_at(reader, middle);
    if (!at) return at;
    if (at->time_us <= utc_us) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return edit_at(reader, low);
}

}  // namespace runstone
