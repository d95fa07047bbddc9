// LinkCallbacks: what a link to the server reports. A link is a connection that is made again after
// a loss. Thread: that of the link.
#pragma once
#include <optional>
#include <string>

#include "client/stream/message_stream.hpp"
#include "common/core/channel_binding.hpp"

namespace runstone {

class LinkCallbacks : public MessageSink {
 public:
  /// `binding` identifies an encrypted connection.
  virtual void on_connected(ConnectionNumber connection,
                            const std::optional<ChannelBinding>& binding) = 0;
  /// `connection` is 0 if no connection could be made.
  virtual void on_disconnected(ConnectionNumber connection, std::string why) = 0;
  /// While this returns true the link reads nothing, and TCP holds the server back.
  virtual bool is_full() { return false; }
};

}  // namespace runstone
