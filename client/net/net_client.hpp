// NetClient: a thread with one link to the server, for a program whose main thread must never wait.
// Bounds:
//   - `events_max` events that were not taken, and `event_bytes_max` of memory that their messages
//     take, whichever comes first; beyond it the link stops reading and TCP holds the server back.
//     The messages in kDecodeBytes (link.cpp) more may be decoded;
//   - kSendBytesMax bytes to send; beyond it the link closes the connection.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client/net/link.hpp"

namespace runstone {

struct LinkConnected {
  ConnectionNumber connection = 0;
  std::optional<ChannelBinding> binding;  // of an encrypted connection
  bool is_listed = false;                 // as in Link::Attempt
};
struct LinkDisconnected {
  ConnectionNumber connection = 0;  // 0: no connection could be made
  std::string why;
  HostPort server;  // that it led to
};
using LinkEvent = std::variant<LinkConnected, LinkReceived, LinkDisconnected>;

class NetClient {
 public:
  /// Starts connecting. `wake` is called from the network thread after each new event.
  NetClient(LinkConfig config, std::function<void()> wake);
  /// Stops and joins.
  ~NetClient();
  NetClient(const NetClient&) = delete;
  NetClient& operator=(const NetClient&) = delete;

  /// Returns the events since the last call, in order.
  std::vector<LinkEvent> take_events();
  /// These calls have the meaning of those of Link. stop() also waits for the thread to end.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  void close(ConnectionNumber connection);
  void set_servers(const Servers& list);
  void stop(std::int64_t milliseconds);
  const LinkStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
