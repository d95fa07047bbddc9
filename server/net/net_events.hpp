// NetEvents: the events of network sessions. For each session: either on_refused() alone, or
// on_connected(), then messages and drains, then on_disconnected() exactly once.
// Threads: the session's strand, one call at a time for each session. A call must return soon.
#pragma once
#include <cstddef>
#include <optional>

#include "common/core/channel_binding.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

class NetEvents {
 public:
  virtual ~NetEvents() = default;
  /// Reports that the connection ended before it was ready: the TLS handshake failed.
  virtual void on_refused(SessionId session) = 0;
  /// Reports that messages can be exchanged. `binding` identifies an encrypted connection.
  virtual void on_connected(SessionId session, const std::optional<ChannelBinding>& binding) = 0;
  /// Brings a verified message of `bytes` bytes. The receiver must call NetSession::handled(bytes)
  /// when it has handled the message, from any thread. A session with too many unhandled bytes
  /// stops reading, and TCP makes the client wait.
  virtual void on_message(SessionId session, Message&& message, std::size_t bytes) = 0;
  /// Reports that the queues have room again after a send that did not fit.
  virtual void on_drained(SessionId session) = 0;
  virtual void on_disconnected(SessionId session) = 0;
};

}  // namespace runstone
