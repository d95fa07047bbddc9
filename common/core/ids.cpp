#include "common/core/ids.hpp"

#include "common/core/hash.hpp"

namespace runstone {

TraceId trace_id(const OperationId& op) {
  return mix64(mix64(mix64(op.author) ^ op.instance) ^ op.seq);
}

}  // namespace runstone
