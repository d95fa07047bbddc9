// NetEvents: what sessions tell the rest of the server. Called on the session's strand, one call at a time
// per session and in order: connected, then messages, then disconnected exactly once. Must return soon.
#pragma once
#include <cstddef>

#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class NetEvents {
 public:
  virtual ~NetEvents() = default;
  virtual void on_connected(SessionId session) = 0;
  /// A verified message of so many bytes. The receiver calls NetSession::handled() with them for each, from any
  /// thread, once it is done with it: a session of which too much is unhandled stops reading, and TCP pushes back.
  virtual void on_message(SessionId session, Message&& message, std::size_t bytes) = 0;
  /// After a refused send: there is room again.
  virtual void on_drained(SessionId session) = 0;
  virtual void on_disconnected(SessionId session) = 0;
};

}  // namespace runstone
