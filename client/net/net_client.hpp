// NetClient: one thread that carries one link to the server, for a program whose main thread must never wait.
// Bounds: events not taken, `events_max` (full: reading stops and TCP holds the server back); bytes to send,
// kSendBytesMax.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "client/net/link.hpp"

namespace runstone {

struct NetConnected {
  ConnectionNumber connection = 0;
};
struct NetDisconnected {
  ConnectionNumber connection = 0;  // 0: no connection came up at all
  std::string why;
};
using NetEvent = std::variant<NetConnected, NetReceived, NetDisconnected>;

class NetClient {
 public:
  /// Starts connecting. `wake` is called from the network thread whenever there is an event to take.
  NetClient(NetConfig config, std::function<void()> wake);
  /// Stops and joins.
  ~NetClient();
  NetClient(const NetClient&) = delete;
  NetClient& operator=(const NetClient&) = delete;

  /// Everything since the last call, in order.
  std::vector<NetEvent> take_events();
  /// Queues a message. Of what is queued, edits go first. Ignored if the connection is gone.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once everything queued is sent. Another one is made after a pause.
  void close(ConnectionNumber connection);
  /// Ends for good after sending what is queued, but waits at most `milliseconds` for that.
  void stop(std::int64_t milliseconds);
  const NetStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
