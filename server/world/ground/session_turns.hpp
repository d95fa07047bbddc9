// SessionTurns: the sessions that wait for a piece of work, which take turns.
//
// Thread: the world strand.
#pragma once
#include <optional>
#include <set>

#include "common/core/ids.hpp"

namespace runstone {

class SessionTurns {
 public:
  /// Adds a session, unless it waits already.
  void insert(SessionId session) { waiting_.insert(session); }
  void erase(SessionId session) { waiting_.erase(session); }
  bool empty() const { return waiting_.empty(); }
  /// Removes and returns the session whose turn it is: the one with the lowest number above that of
  /// the last turn, or the lowest of all if there is none. Returns nullopt if nobody waits. The
  /// session may be closed by now.
  std::optional<SessionId> take_next() {
    if (waiting_.empty()) return std::nullopt;
    auto next = waiting_.upper_bound(last_);
    if (next == waiting_.end()) next = waiting_.begin();
    last_ = *next;
    waiting_.erase(next);
    return last_;
  }

 private:
  std::set<SessionId> waiting_;
  SessionId last_ = 0;
};

}  // namespace runstone
