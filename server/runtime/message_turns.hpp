// MessageTurns: the messages of sessions that wait for the world strand. Sessions take turns with
// one message each. So a message waits for at most one message of each other session and for those
// of its own session, however many and however costly messages the others have sent.
// Bound: NetLimits::unhandled_bytes_max for each session.
// Thread: the world strand.
#pragma once
#include <cstddef>
#include <deque>
#include <map>
#include <optional>

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

  /// Queues a message behind the others of its session.
  void push(SessionId session, Message&& message, std::size_t bytes);
  /// Removes and returns the next message. Returns nullopt if none waits.
  std::optional<Turn> next();
  /// Removes and returns the next message of this session. Returns nullopt if none waits.
  std::optional<Turn> next_of(SessionId session);
  bool is_empty() const { return waiting_.empty(); }

 private:
  using Waiting = std::map<SessionId, std::deque<Turn>>;
  Turn take(Waiting::iterator session);

  Waiting waiting_;   // no entry is empty
  SessionId last_{};  // the session of the last turn
};

}  // namespace runstone
