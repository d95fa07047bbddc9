#include "server/history/log_marks.hpp"

#include <algorithm>

namespace runstone {

StoreResult<FoundLogMarks> read_log_marks(LogReader& reader, const LogMarksRequest& request) {
  const auto range = reader.log_range();
  if (!range) return failure(range.error());
  FoundLogMarks out;
  out.first = std::max<Sequence>(1, range->first);
  const Sequence first = std::max(request.first, range->first);
  const Sequence last = std::min(request.last, range->last.version.seq);
  if (first > last) return out;
  const Sequence steps = request.count - 1U, span = last - first;
  Sequence before = 0;
  for (Sequence i = 0; i <= steps; ++i) {
    // In two parts, so that the product does not overflow.
    const Sequence seq = steps == 0 ? last : first + span / steps * i + span % steps * i / steps;
    if (seq == before) continue;
    before = seq;
    const auto read = reader.read_log(seq, seq, [&](const EditRecord& record) {
      // Clients of version 2 of the protocol know no later cause.
      if (static_cast<std::uint8_t>(record.cause) > kLogMarkCauseMax) return true;
      out.marks.push_back({record.version.seq, record.time_us, record.op.author, record.cause,
                           kind_of(record.edit)});
      return true;
    });
    if (!read) return failure(read.error());
  }
  return out;
}

}  // namespace runstone
