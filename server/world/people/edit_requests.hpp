// EditRequests: decides about the edits of players: each is queued for the next commit, or answered
// with a reject. An edit passes a list of checks, and the first refusal wins.
//
// With the feature large actions, an edit of an action waits (WaitingEdits) where another edit is
// rejected for a while: until the budget suffices, or log, memory and the queue of large edits have
// room. It also waits while the log is asked for an action that is not remembered (LargeActions). A
// step decides about a bounded number of the edits that wait, session by session.
//
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "server/world/order/receipts.hpp"
#include "server/world/people/waiting_edits.hpp"
#include "server/world/rights/quotas.hpp"

namespace runstone {

class EditRequests {
 public:
  EditRequests(const WorldConfig& config, WorldEnvironment& environment, WorldCounters& counters,
               Sessions& sessions, Order& order, Receipts& receipts, Rights& rights, Quotas& quotas)
      : config_(config),
        environment_(environment),
        counters_(counters),
        sessions_(sessions),
        order_(order),
        receipts_(receipts),
        rights_(rights),
        quotas_(quotas) {}

  /// The edits that wait about which one step() decides.
  static constexpr std::size_t kEditsPerStep = 64;

  /// Queues the edit for the next commit, answers with a reject, or keeps the edit waiting. Closes
  /// the session if too many of its edits wait (flooding). Returns true if it was accepted.
  bool on_edit(Session& session, const EditRequest& request, const Clocks& now);
  /// Decides about edits that wait, as far as they can go on: at most kEditsPerStep, each session in
  /// turn. Calls `on_accepted` for each that is queued for a commit. Call it on every tick. A server
  /// that follows forgets them: their clients offer them to the owner.
  void step(const Clocks& now, const std::function<void(Session&)>& on_accepted);
  /// Takes the answer to WorldEnvironment::find_action(), or nullopt if the log could not be read.
  void action_found(const OperationId& first_op, const std::optional<FoundAction>& found,
                    const Clocks& now);
  /// Ends an action of the author, whose first edit is `first`: it takes no more edits. Returns its
  /// newest edit that was ordered, or 0 if it is not remembered.
  Sequence end_action(AuthorId author, Sequence first) {
    return order_.authority().large_actions().end(author, first);
  }
  /// Returns the number of edits that wait. Cost: O(sessions).
  std::size_t waiting() const { return waiting_.size(); }
  /// Rejects an edit that no server accepts, for a server that passes edits on: it does not decode,
  /// or an earlier edit of its action was rejected here for that reason. Returns true if it was
  /// rejected.
  bool reject_invalid(Session& session, const EditRequest& request);
  void forget(SessionId session) {
    refused_.erase(session);
    looked_up_.erase(session);
    waiting_.forget(session);
  }

 private:
  struct Attempt {
    Session& session;
    const EditRequest& request;
    OperationId op;
    Payer payer;
    const Clocks& now;
    /// An edit of an action of a session with the feature large actions: it waits where it can.
    bool is_patient() const { return request.action != 0 && session.has(kFeatureLargeActions); }
  };
  struct Refusal {
    RejectReason reason;
    std::string detail = {};  // for the player
    bool is_to_wait = false;  // the edit is not rejected: it waits
  };
  enum class Verdict { accepted, rejected, waits };
  // The checks. Each returns why the edit is refused, or nullopt.
  using Check = std::optional<Refusal> (EditRequests::*)(const Attempt&);
  std::optional<Refusal> check_action(const Attempt& attempt);
  std::optional<Refusal> check_room(const Attempt& attempt);
  std::optional<Refusal> check_budget(const Attempt& attempt);
  std::optional<Refusal> check_bytes(const Attempt& attempt);
  std::optional<Refusal> check_reach(const Attempt& attempt);
  std::optional<Refusal> check_border(const Attempt& attempt);
  std::optional<Refusal> check_edit(const Attempt& attempt);
  std::optional<Refusal> check_rights(const Attempt& attempt);
  /// Returns why an edit of a patient session cannot join its action, or nullopt.
  std::optional<Refusal> check_standing(const Attempt& attempt);
  Verdict decide(Session& session, const EditRequest& request, const Clocks& now);
  void keep_waiting(Session& session, const EditRequest& request);
  /// Queues the edit if it passes all checks, in the order of the list. Returns why it is refused or
  /// waits, or nullopt if it was queued.
  std::optional<Refusal> check_and_enqueue(const Attempt& attempt);
  void refuse(const Attempt& attempt, Refusal refusal);
  const char* why_busy(const Attempt& attempt) const;

  /// The last action of which an edit was refused that is not optional, and why: its later edits are
  /// refused as well. A move then does not clear a place whose copy was refused.
  struct RefusedAction {
    ClientSequence action = 0;
    RejectReason reason = RejectReason::busy;
  };

  const WorldConfig& config_;
  WorldEnvironment& environment_;
  WorldCounters& counters_;
  Sessions& sessions_;
  Order& order_;
  Receipts& receipts_;
  Rights& rights_;
  Quotas& quotas_;
  std::map<SessionId, RefusedAction> refused_;
  WaitingEdits waiting_;
  /// A question to the log about an action.
  struct Lookup {
    OperationId first_op;
    TimeUs again_us = kUnanswered;  // the log could not be read: when it is asked again
    static constexpr TimeUs kUnanswered = std::numeric_limits<TimeUs>::max();
  };
  /// By the session whose oldest edit waits for the answer.
  std::map<SessionId, Lookup> looked_up_;
};

}  // namespace runstone
