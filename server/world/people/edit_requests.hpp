// EditRequests: decides about the edits of players: each is queued for the next commit, or answered
// with a reject. An edit passes a list of checks, and the first refusal wins.
//
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "server/world/order/receipts.hpp"
#include "server/world/rights/quotas.hpp"

namespace runstone {

class EditRequests {
 public:
  EditRequests(const WorldConfig& config, WorldCounters& counters, Sessions& sessions, Order& order,
               Receipts& receipts, Rights& rights, Quotas& quotas)
      : config_(config),
        counters_(counters),
        sessions_(sessions),
        order_(order),
        receipts_(receipts),
        rights_(rights),
        quotas_(quotas) {}

  /// Queues the edit for the next commit, or answers with a reject. Returns true if it was
  /// accepted.
  bool on_edit(Session& session, const EditRequest& request, const Clocks& now);
  /// Rejects an edit that no server accepts, for a server that passes edits on: it does not decode,
  /// or an earlier edit of its action was rejected here for that reason. Returns true if it was
  /// rejected.
  bool reject_invalid(Session& session, const EditRequest& request);
  void forget(SessionId session) { refused_.erase(session); }

 private:
  struct Attempt {
    Session& session;
    const EditRequest& request;
    OperationId op;
    Payer payer;
    const Clocks& now;
  };
  struct Refusal {
    RejectReason reason;
    std::string detail = {};  // for the player
  };
  // The checks. Each returns why the edit is refused, or nullopt.
  using Check = std::optional<Refusal> (EditRequests::*)(const Attempt&);
  std::optional<Refusal> check_action(const Attempt& attempt);
  std::optional<Refusal> check_room(const Attempt& attempt);
  std::optional<Refusal> check_budget(const Attempt& attempt);
  std::optional<Refusal> check_bytes(const Attempt& attempt);
  std::optional<Refusal> check_reach(const Attempt& attempt);
  std::optional<Refusal> check_edit(const Attempt& attempt);
  std::optional<Refusal> check_rights(const Attempt& attempt);
  /// Queues the edit if it passes all checks, in the order of the list. Returns why it is refused, or
  /// nullopt if it was queued.
  std::optional<Refusal> check_and_enqueue(const Attempt& attempt);
  void refuse(const Attempt& attempt, Refusal refusal);
  const char* why_busy(const Attempt& attempt) const;

  /// The last action of which an edit was refused, and why: its later edits are refused as well. A
  /// move then does not clear a place whose copy was refused.
  struct RefusedAction {
    ClientSequence action = 0;
    RejectReason reason = RejectReason::busy;
  };

  const WorldConfig& config_;
  WorldCounters& counters_;
  Sessions& sessions_;
  Order& order_;
  Receipts& receipts_;
  Rights& rights_;
  Quotas& quotas_;
  std::map<SessionId, RefusedAction> refused_;
};

}  // namespace runstone
