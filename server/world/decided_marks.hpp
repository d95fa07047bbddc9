// DecidedMarks: per author and client instance the highest client sequence that was applied or refused.
// Client sequences of one instance ascend (gaps are allowed), so one number says of any operation whether it
// was decided. Every refusal is final, or an edit offered again could end up behind a later one. Refusals are
// remembered with their reason, so that a client whose answer was lost with its connection can ask again; the
// oldest are forgotten beyond kRefusalsMax an instance. A start fills the marks from the store, which knows
// applied edits only; refusals count until the server stops.
#pragma once
#include <algorithm>
#include <map>
#include <utility>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class DecidedMarks {
 public:
  ClientSequence of(AuthorId author, ClientInstance instance) const {
    const auto found = marks_.find({author, instance});
    return found == marks_.end() ? 0 : found->second;
  }
  bool knows(const OperationId& op) const { return op.seq <= of(op.author, op.instance); }
  /// Decides an edit by refusing it.
  void refuse(const OperationId& op, RejectReason reason) {
    raise(op);
    auto& refusals = refusals_[{op.author, op.instance}];
    refusals.insert_or_assign(op.seq, reason);
    if (refusals.size() > kRefusalsMax) refusals.erase(refusals.begin());
  }
  /// How a decided edit was answered: its refusal, or already_decided (applied, as far as this run knows).
  RejectReason answer_to(const OperationId& op) const {
    const auto instance = refusals_.find({op.author, op.instance});
    if (instance == refusals_.end()) return RejectReason::already_decided;
    const auto found = instance->second.find(op.seq);
    return found == instance->second.end() ? RejectReason::already_decided : found->second;
  }
  /// Never lowers a mark.
  void raise(const OperationId& op) {
    ClientSequence& mark = marks_[{op.author, op.instance}];
    mark = std::max(mark, op.seq);
  }

  static constexpr std::size_t kRefusalsMax = 1024;

 private:
  std::map<std::pair<AuthorId, ClientInstance>, ClientSequence> marks_;
  std::map<std::pair<AuthorId, ClientInstance>, std::map<ClientSequence, RejectReason>> refusals_;
};

}  // namespace runstone
