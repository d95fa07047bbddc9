// Link: a connection to a server that is made again after a loss. It carries the messages of a
// MessageStream over TCP and TLS, or over a WebSocket of a gateway. After a loss it connects again,
// to another server of the world if it knows one, until it is stopped (ConnectOrder). Messages
// carry the number of their connection; those of an older connection are dropped. The io_context
// belongs to the caller, so one thread may run one link (NetClient) or a thousand (bots).
// Thread: all calls and callbacks on the one thread that runs the io_context.
#pragma once
#include <asio/io_context.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/net/link_target.hpp"
#include "client/stream/connect_order.hpp"
#include "client/stream/link_callbacks.hpp"
#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"

namespace runstone {

struct LinkConfig {
  std::string host;
  std::uint16_t port = 0;
  std::vector<HostPort> more = {};  // further addresses of the world that the user gave
  /// nullopt: the connection is not encrypted.
  std::optional<TlsContext> tls = TlsContext::client();
  /// Path of the WebSocket of a gateway, such as "/play". Empty: `port` is that of the server,
  /// which takes frames without a WebSocket.
  std::string web_path = {};
  // Of NetClient: events that were not taken yet, and the memory of their messages.
  std::size_t events_max = 4096;
  std::size_t event_bytes_max = std::size_t{16} << 20;
  std::int64_t connect_ms_max = 5'000;
  /// See ConnectPauses.
  std::int64_t pause_ms_first = 100, pause_ms_max = 3'000;
};

class Link {
 public:
  /// `io` and `callbacks` must outlive the link. `io` must not run any more when the link is
  /// destroyed.
  Link(asio::io_context& io, LinkConfig config, LinkCallbacks& callbacks);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  using Attempt = ConnectOrder<LinkTarget>::Attempt;

  /// Starts connecting. Call once.
  void start();
  /// Takes the servers of the world. The list is one of the server that the link is connected to.
  void set_servers(const Servers& list);
  /// Returns the newest attempt to connect. In a callback it is that of the connection.
  const Attempt& attempt() const;
  /// Queues a message. Queued edits are sent before other messages. Does nothing if the connection
  /// has ended.
  void send(ConnectionNumber connection, const EncodedMessage& message);
  /// Closes this connection once all queued messages are sent. The link connects again after a
  /// pause.
  void close(ConnectionNumber connection);
  /// Stops the link after the queued messages are sent, or after `wait_ms`. Then the io_context has
  /// no more work of the link.
  void stop(std::int64_t wait_ms);
  const LinkStats& stats() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace runstone
