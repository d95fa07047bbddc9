// ConnectedSessions: the network sessions that the world strand knows, by number. A session is
// listed from its connection to its disconnection.
// Threads: the world strand.
#pragma once
#include <memory>
#include <unordered_map>
#include <utility>

#include "common/core/assert.hpp"
#include "server/net/net_session.hpp"
#include "server/runtime/world_strand.hpp"

namespace runstone {

class ConnectedSessions {
 public:
  /// `strand` must outlive the object.
  explicit ConnectedSessions(const WorldStrand& strand) : strand_(strand) {}

  void add(SessionId id, std::shared_ptr<NetSession> session) {
    sessions_.emplace(id, std::move(session));
  }
  void remove(SessionId id) { sessions_.erase(id); }
  bool is_empty() const { return sessions_.empty(); }

  /// Returns the session, or a null pointer if it is not connected. The reference is valid until
  /// the next remove().
  const std::shared_ptr<NetSession>& find(SessionId id) const {
    RUNSTONE_ASSERT(strand_.is_current());
    static const std::shared_ptr<NetSession> none;
    const auto found = sessions_.find(id);
    return found == sessions_.end() ? none : found->second;
  }

 private:
  const WorldStrand& strand_;
  std::unordered_map<SessionId, std::shared_ptr<NetSession>> sessions_;
};

}  // namespace runstone
