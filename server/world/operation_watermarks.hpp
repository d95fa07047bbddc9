// OperationWatermarks: per author and client instance the highest client sequence that was applied or refused.
// Client sequences of one instance ascend (gaps are allowed), so one number says of any operation whether it
// was decided. Every refusal is final, or an edit offered again could end up behind a later one. Refusals are
// remembered with their reason, so that a client whose answer was lost with its connection can ask again; the
// oldest are forgotten beyond kRefusalsMax an instance, and beyond kRefusalsTotalMax in all those of the
// instances that were not refused anything for longest. A start fills the marks from the store, which knows
// applied edits only; refusals count until the server stops.
#pragma once
#include <algorithm>
#include <list>
#include <map>
#include <utility>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class OperationWatermarks {
 public:
  ClientSequence of(AuthorId author, ClientInstance instance) const {
    const auto found = marks_.find({author, instance});
    return found == marks_.end() ? 0 : found->second;
  }
  bool knows(const OperationId& op) const { return op.seq <= of(op.author, op.instance); }
  /// Decides an edit by refusing it.
  void refuse(const OperationId& op, RejectReason reason) {
    raise(op);
    const auto [mine, is_new] = refusals_.try_emplace({op.author, op.instance});
    if (is_new) mine->second.place = by_use_.insert(by_use_.end(), mine->first);
    by_use_.splice(by_use_.end(), by_use_, mine->second.place);
    auto& reasons = mine->second.reasons;
    refusal_count_ += reasons.insert_or_assign(op.seq, reason).second ? 1 : 0;
    if (reasons.size() > kRefusalsMax) {
      reasons.erase(reasons.begin());
      --refusal_count_;
    }
    // The newest instance has kRefusalsMax at most, so this ends before it comes to that one.
    while (refusal_count_ > kRefusalsTotalMax) forget_refusals(refusals_.find(by_use_.front()));
  }
  /// How a decided edit was answered: its refusal, or already_resolved (applied, as far as this run knows).
  RejectReason answer_to(const OperationId& op) const {
    const auto instance = refusals_.find({op.author, op.instance});
    if (instance == refusals_.end()) return RejectReason::already_resolved;
    const auto found = instance->second.reasons.find(op.seq);
    return found == instance->second.reasons.end() ? RejectReason::already_resolved : found->second;
  }
  /// Never lowers a mark.
  void raise(const OperationId& op) {
    ClientSequence& mark = marks_[{op.author, op.instance}];
    mark = std::max(mark, op.seq);
  }
  /// Nobody will ask for this author again: its number is not given a second time.
  void forget(AuthorId author) {
    const Instance first{author, 0};
    const auto is_mine = [&](const auto& entry) { return entry.first.first == author; };
    for (auto at = refusals_.lower_bound(first); at != refusals_.end() && is_mine(*at);) {
      forget_refusals(at++);
    }
    auto end = marks_.lower_bound(first);
    while (end != marks_.end() && is_mine(*end)) ++end;
    marks_.erase(marks_.lower_bound(first), end);
  }

  std::size_t refusal_count() const { return refusal_count_; }
  std::size_t mark_count() const { return marks_.size(); }

  static constexpr std::size_t kRefusalsMax = 1024;
  static constexpr std::size_t kRefusalsTotalMax = 65'536;
  static_assert(kRefusalsMax < kRefusalsTotalMax);

 private:
  using Instance = std::pair<AuthorId, ClientInstance>;
  struct Refusals {
    std::map<ClientSequence, RejectReason> reasons;
    std::list<Instance>::iterator place;  // in by_use_
  };
  void forget_refusals(std::map<Instance, Refusals>::iterator of) {
    refusal_count_ -= of->second.reasons.size();
    by_use_.erase(of->second.place);
    refusals_.erase(of);
  }

  std::map<Instance, ClientSequence> marks_;
  std::map<Instance, Refusals> refusals_;
  std::list<Instance> by_use_;  // of refusals_, the one refused last at the end
  std::size_t refusal_count_ = 0;
};

}  // namespace runstone
