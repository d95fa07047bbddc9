// MessageTurns: the messages of sessions that wait for the world strand. Sessions take turns with
// one message each. So a message waits for at most one message of each other session and for those
// of its own session, however many and however costly messages the others have sent. A player's
// session at another server of the world takes turns like one here, although its messages come
// through the one session of that server. So only messages of one player are in order.
// Bound: NetLimits::unhandled_bytes_max for each session.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class MessageTurns {
 public:
  struct Turn {
    SessionId session;
    Message message;
    std::size_t bytes;  // of the message, as in NetEvents::on_message()
  };

  /// Queues a message behind the others of its session, or of its player's session.
  void push(SessionId session, Message&& message, std::size_t bytes);
  /// Removes and returns the next message. Returns nullopt if none waits.
  std::optional<Turn> next();
  /// Removes and returns the next message of this session. Returns nullopt if none waits.
  std::optional<Turn> next_of(SessionId session);
  bool is_empty() const { return waiting_.empty(); }

 private:
  /// Who takes turns: a session, and the number that another server gave to the session of its
  /// player. 0: the session itself.
  using Lane = std::pair<SessionId, SessionId>;
  using Waiting = std::map<Lane, std::deque<Turn>>;
  static Lane lane_of(SessionId session, const Message& message);
  Turn take(Waiting::iterator lane);

  Waiting waiting_;  // no entry is empty
  Lane last_{};      // that of the last turn
};

}  // namespace runstone
