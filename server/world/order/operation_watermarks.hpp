// OperationWatermarks: the highest resolved client sequence of each author and client instance. An
// operation is resolved when its edit was accepted or rejected. Client sequences of one instance
// ascend (gaps are allowed), so one number tells of any operation whether it is resolved. A
// rejection is final: if an edit could be accepted later, it could be ordered behind a newer edit
// of the same client. Rejections are kept with their reasons, so that a client that lost the answer
// with its connection gets it again. Bounds: kRejectionsMax per instance, the oldest are dropped
// first; kRejectionsTotalMax in all, the instances whose last rejection is oldest lose theirs
// first.
// A start restores the watermarks from the store, which knows accepted edits only. Rejections are
// lost when the server stops.
// A repaired world may lack watermarks. Then an operation above the known watermark may have been
// applied before the repair. Those of the instances of that time are refused. An instance without a
// watermark counts as one if its first operation is not 1, because each client counts from 1. So a
// newer one counts, too, if it had only rejected edits when the server stopped.
#pragma once
#include <algorithm>
#include <list>
#include <map>
#include <set>
#include <span>
#include <utility>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"
#include "server/world/environment/player_rows.hpp"

namespace runstone {

class OperationWatermarks {
 public:
  ClientSequence of(AuthorId author, ClientInstance instance) const {
    const auto found = marks_.find({author, instance});
    return found == marks_.end() ? 0 : found->second;
  }
  bool knows(const OperationId& op) const { return op.seq <= of(op.author, op.instance); }
  /// Resolves an operation as rejected.
  void reject(const OperationId& op, RejectReason reason) {
    raise(op);
    const auto [mine, is_new] = rejections_.try_emplace({op.author, op.instance});
    if (is_new) mine->second.place = by_use_.insert(by_use_.end(), mine->first);
    by_use_.splice(by_use_.end(), by_use_, mine->second.place);
    auto& reasons = mine->second.reasons;
    rejection_count_ += reasons.insert_or_assign(op.seq, reason).second ? 1 : 0;
    if (reasons.size() > kRejectionsMax) {
      reasons.erase(reasons.begin());
      --rejection_count_;
    }
    // The newest instance has at most kRejectionsMax, so the loop ends before it reaches that one.
    while (rejection_count_ > kRejectionsTotalMax)
      forget_rejections(rejections_.find(by_use_.front()));
  }
  /// Returns the answer to a resolved operation: the reason of its rejection, or already_resolved
  /// if no rejection is kept.
  RejectReason answer_to(const OperationId& op) const {
    const auto instance = rejections_.find({op.author, op.instance});
    if (instance == rejections_.end()) return RejectReason::already_resolved;
    const auto found = instance->second.reasons.find(op.seq);
    return found == instance->second.reasons.end() ? RejectReason::already_resolved : found->second;
  }
  /// Resolves an operation as accepted. Never lowers a watermark. A rejection of the operation is
  /// dropped: another owner of the world has ordered an edit whose rejection never reached the
  /// client.
  void raise(const OperationId& op) {
    ClientSequence& mark = marks_[{op.author, op.instance}];
    mark = std::max(mark, op.seq);
    const auto rejected = rejections_.find({op.author, op.instance});
    if (rejected == rejections_.end() || rejected->second.reasons.erase(op.seq) == 0) return;
    --rejection_count_;
    if (rejected->second.reasons.empty()) forget_rejections(rejected);
  }
  /// Sets the watermarks of a world, whose other state is empty.
  void restore(std::span<const HighWater> rows) {
    TimeUs lost_until_us = 0;
    for (const HighWater& row : rows) {
      if (!is_of_lost_watermarks(row)) continue;
      lost_author_max_ = static_cast<AuthorId>(row.resolved);
      lost_until_us = row.last_us;
    }
    for (const HighWater& row : rows) {
      raise({row.author, row.instance, row.resolved});
      if (row.author != 0 && row.author <= lost_author_max_ && row.last_us <= lost_until_us)
        before_repair_.insert({row.author, row.instance});
    }
  }
  /// Returns true if an operation may have been applied before a repair that lost its watermark.
  /// Requires that knows() returns false for it.
  bool may_be_applied(const OperationId& op) const {
    if (op.author == 0 || op.author > lost_author_max_) return false;
    const Instance instance{op.author, op.instance};
    return marks_.contains(instance) ? before_repair_.contains(instance) : op.seq != 1;
  }
  /// Drops everything about an author whose number is not used any more.
  void forget(AuthorId author) {
    const Instance first{author, 0};
    const auto is_mine = [&](const auto& entry) { return entry.first.first == author; };
    for (auto at = rejections_.lower_bound(first); at != rejections_.end() && is_mine(*at);) {
      forget_rejections(at++);
    }
    std::erase_if(before_repair_, [&](const Instance& one) { return one.first == author; });
    auto end = marks_.lower_bound(first);
    while (end != marks_.end() && is_mine(*end)) ++end;
    marks_.erase(marks_.lower_bound(first), end);
  }

  std::size_t rejection_count() const { return rejection_count_; }
  std::size_t mark_count() const { return marks_.size(); }

  static constexpr std::size_t kRejectionsMax = 1024;
  static constexpr std::size_t kRejectionsTotalMax = 65'536;
  static_assert(kRejectionsMax < kRejectionsTotalMax);

 private:
  using Instance = std::pair<AuthorId, ClientInstance>;
  struct Rejections {
    std::map<ClientSequence, RejectReason> reasons;
    std::list<Instance>::iterator place;  // in by_use_
  };
  void forget_rejections(std::map<Instance, Rejections>::iterator of) {
    rejection_count_ -= of->second.reasons.size();
    by_use_.erase(of->second.place);
    rejections_.erase(of);
  }

  std::map<Instance, ClientSequence> marks_;
  // Authors up to this one may lack watermarks; 0: nobody does.
  AuthorId lost_author_max_ = 0;
  std::set<Instance> before_repair_;  // instances with a watermark that may be too low
  std::map<Instance, Rejections> rejections_;
  std::list<Instance> by_use_;  // the keys of rejections_; the last rejection is at the end
  std::size_t rejection_count_ = 0;
};

}  // namespace runstone
