// LostEdits: edits from before a reconnection that the server rejects for a while, because its log
// is full, or because they cost more than is left of the edit budget. The player saw these edits
// applied: there was no connection then, or the server lost them when it ended. So they are
// offered again, as new edits, until the server accepts them.
// Bound: the edits that LocalEdits kept at the reconnection. Thread: one. Times are arguments.
#pragma once
#include <algorithm>
#include <deque>
#include <set>

#include "client/replica/local_edits.hpp"

namespace runstone {

struct LostEdit {
  ClientSequence seq = 0;  // with which it was offered first
  EditDescriptor edit;
  TimeUs submitted_us = 0;
  ClientSequence action = 0;  // as LocalEdit::action
};

class LostEdits {
 public:
  /// The time from a rejection to the next attempt.
  static constexpr TimeUs kAgainUs = 1'000'000;

  /// Takes the edit over if it is older than the connection, which opened at `opened_us`, the
  /// reason of the rejection is temporary, and no ActionSender offers it again. Call it before
  /// LocalEdits takes the rejection. Returns true if it took the edit over.
  bool take(const LocalEdits& edits, const Reject& reject, TimeUs opened_us, TimeUs now_us) {
    const bool is_temporary =
        reject.reason == RejectReason::busy || reject.reason == RejectReason::rate_limited;
    const LocalEdit* local = edits.find(reject.client_seq);
    const bool is_again = again_.erase(reject.client_seq) != 0;
    if (!is_temporary || local == nullptr || local->has_sender) return false;
    if (!is_again && local->submitted_us >= opened_us) return false;
    const ClientSequence first = local->again_of != 0 ? local->again_of : reject.client_seq;
    edits_.push_back({first, local->edit, local->submitted_us, local->action});
    put_off(now_us);
    return true;
  }
  /// Returns the oldest edit if it is time to offer it, otherwise null.
  const LostEdit* due(TimeUs now_us) const {
    return edits_.empty() || now_us < due_us_ ? nullptr : &edits_.front();
  }
  /// Returns true if an edit that was offered first with this sequence waits here.
  bool has(ClientSequence seq) const {
    return std::any_of(edits_.begin(), edits_.end(),
                       [&](const LostEdit& edit) { return edit.seq == seq; });
  }
  /// Returns the action with which the oldest edit is offered, so that the edits of one action
  /// stay one action. Requires that due() returned the edit.
  ClientSequence action() const {
    const ClientSequence was = edits_.front().action;
    if (was == 0) return 0;
    return was == action_ ? new_action_ : kBeginsAction;
  }
  /// Removes the oldest edit, which was offered as `seq`.
  void offered(ClientSequence seq) {
    const ClientSequence was = edits_.front().action;
    if (was != action_) new_action_ = seq;
    action_ = was;
    edits_.pop_front();
    again_.insert(seq);
  }
  /// Removes the oldest edit, which can never be offered.
  void drop() { edits_.pop_front(); }
  void put_off(TimeUs now_us) { due_us_ = now_us + kAgainUs; }
  /// Forgets the offered edits that are safe by now.
  void forget_settled(const LocalEdits& edits) {
    std::erase_if(again_, [&](ClientSequence seq) { return edits.find(seq) == nullptr; });
  }
  void clear() {
    edits_.clear();
    again_.clear();
    action_ = 0;
  }

 private:
  std::deque<LostEdit> edits_;
  std::set<ClientSequence> again_;  // that were offered again and may be rejected once more
  ClientSequence action_ = 0, new_action_ = 0;  // of the edit that was offered last
  TimeUs due_us_ = 0;
};

}  // namespace runstone
