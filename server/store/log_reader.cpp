#include "server/store/log_reader.hpp"

namespace runstone {

StoreResult<Sequence> LogReader::last_sequence() {
  const auto range = log_range();
  if (!range) return Unexpected<StoreError>{range.error()};
  return range->last.version.seq;
}

}  // namespace runstone
