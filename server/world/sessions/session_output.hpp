// SessionOutput: sends to the sessions of players, wherever they are connected: here, or to another
// server that follows this one. Messages for sessions there go through the link with that server
// (docs/protocol.md, "Between servers"): send_to_all() makes one message for all sessions of a
// link.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/world/environment/world_environment.hpp"

namespace runstone {

/// A player's session at another server.
struct RelayedSession {
  SessionId link = 0;    // the session of the other server
  SessionId remote = 0;  // the number that it gave to the player's session
};

class SessionOutput {
 public:
  /// `environment` must outlive the object.
  explicit SessionOutput(WorldEnvironment& environment) : environment_(environment) {}

  /// Adds a session at another server, and returns the number that it has here. Sockets have
  /// smaller numbers.
  SessionId add(const RelayedSession& relayed);
  void remove(SessionId session) { relayed_.erase(session); }
  /// Returns where the session is connected, or null if it is connected here.
  const RelayedSession* relayed(SessionId session) const;

  // As in WorldEnvironment. The queue of a relayed session is that of its link.
  bool send(SessionId session, const EncodedMessage& message);
  std::vector<SessionId> send_to_all(std::span<const SessionId> sessions,
                                     const EncodedMessage& message);
  void close(SessionId session, GoodbyeReason reason, const std::string& text);
  void charge_reading(SessionId session, std::size_t bytes);

 private:
  WorldEnvironment& environment_;
  std::map<SessionId, RelayedSession> relayed_;
  SessionId next_ = SessionId{1} << 31;
};

}  // namespace runstone
