// WaitingEdits: edits of players that arrived and are not decided yet: those of actions that wait for
// a budget, for room, or until the log has told whether it has their action, and the edits of their
// sessions behind them. The edits of a session keep their order, because one number tells which of
// them are resolved (OperationWatermarks). Sessions take turns.
// Bounds: of a session, has_room_for(). The edits of a session that ends are dropped: they are not
// resolved, so the client offers them again.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <vector>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class WaitingEdits {
 public:
  bool has_any() const { return !queues_.empty(); }
  bool has_any(SessionId session) const { return queues_.contains(session); }
  /// Requires that the edits of the session were pushed in ascending order. Cost: O(log edits).
  bool has(SessionId session, ClientSequence seq) const;
  /// Returns false if the session would have more than kWaitingEditsMax edits here, or more than
  /// kWaitingEditBytesMax by window_bytes().
  bool has_room_for(SessionId session, const EditRequest& request) const;
  void push(SessionId session, const EditRequest& request);
  /// Returns the session's oldest edit. Requires has_any(session).
  const EditRequest& front(SessionId session) const { return queues_.at(session).edits.front(); }
  void pop(SessionId session);
  /// Returns the sessions with edits, in the order of their turns.
  std::vector<SessionId> sessions() const;
  /// The next turn begins with this session, or the one behind it.
  void begin_turn_at(SessionId session) { turn_ = session; }
  void forget(SessionId session) { queues_.erase(session); }
  void clear() { queues_.clear(); }
  /// Returns the number of edits. Cost: O(sessions).
  std::size_t size() const;

 private:
  struct Queue {
    std::deque<EditRequest> edits;
    std::size_t bytes = 0;
  };
  std::map<SessionId, Queue> queues_;  // none is empty
  SessionId turn_ = 0;
};

}  // namespace runstone
