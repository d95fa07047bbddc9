// DecidedMarks: per author and client instance the highest client sequence that was applied or rejected.
// Client sequences of one instance ascend (gaps are allowed), so one number says of any operation whether it
// was decided. A start fills it from the store, which knows applied edits only; rejections count until the
// server stops: the same edit offered to the next run is judged again, and judged alike.
#pragma once
#include <algorithm>
#include <map>
#include <utility>

#include "common/core/ids.hpp"

namespace runstone {

class DecidedMarks {
 public:
  ClientSequence of(AuthorId author, ClientInstance instance) const {
    const auto found = marks_.find({author, instance});
    return found == marks_.end() ? 0 : found->second;
  }
  bool knows(const OperationId& op) const { return op.seq <= of(op.author, op.instance); }
  /// Never lowers a mark.
  void raise(const OperationId& op) {
    ClientSequence& mark = marks_[{op.author, op.instance}];
    mark = std::max(mark, op.seq);
  }

 private:
  std::map<std::pair<AuthorId, ClientInstance>, ClientSequence> marks_;
};

}  // namespace runstone
