// OutgoingLink: a connection to another server of the same world, as its client. It connects once.
// To connect again, make another link.
// Bounds: TrustedLimits. The server may send messages and bytes at any rate.
// Threads: the events come on one strand of the link, one at a time, and must return soon. The
// functions may be called from any thread, after connect(), and return at once.
// Lifetime: a link that has connected lives until its last event, and drops its events then.
// Messages are decoded as in NetSession.
#pragma once
#include <asio/any_io_executor.hpp>
#include <asio/io_context.hpp>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/core/channel_binding.hpp"
#include "common/os/host_port.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/codec/messages.hpp"
#include "server/net/byte_budget.hpp"
#include "server/net/net_session.hpp"

namespace runstone {

class OutgoingLink final : public std::enable_shared_from_this<OutgoingLink>, private NetEvents {
 public:
  /// None of them may be empty.
  struct Events {
    /// Reports that messages can be exchanged. `binding` identifies an encrypted connection.
    std::function<void(const std::optional<ChannelBinding>& binding)> on_connected;
    /// Brings a verified message of `bytes` bytes. The receiver must call handled(bytes) when it
    /// has handled the message. A link with too many unhandled bytes stops reading. A Goodbye is
    /// not reported here: messages that it has overtaken may follow, and then on_ended().
    std::function<void(Message&&, std::size_t bytes)> on_message;
    /// Reports the end of the link, exactly once and last. `why` is for the log, such as "cannot
    /// connect: Connection refused" or "the server said goodbye: the server stops".
    std::function<void(const std::string& why)> on_ended;
  };

  /// The threads of `decoders` must outlive those of `io`. `chunk_edge`: of the world. `tls`:
  /// nullopt for a connection that is not encrypted.
  OutgoingLink(asio::io_context& io, asio::any_io_executor decoders, std::uint16_t chunk_edge,
               std::optional<TlsContext> tls, Events events);

  /// Resolves the name of the server, connects to the first of its addresses that answers, and
  /// performs the TLS handshake, all within `time`. Call it once. Requires a host that is not
  /// empty.
  void connect(const HostPort& server, std::chrono::milliseconds time);
  /// Queues a message. Returns false if its class is full, or before on_connected(). After the end
  /// the message is dropped, and the call returns true.
  bool send(const EncodedMessage& message);
  /// Reports that a message of on_message() was handled.
  void handled(std::size_t bytes);
  /// Sends what is queued and a goodbye with this text, and ends the link, at the latest after a
  /// second. If the link is not connected yet, it ends at once. on_ended() gets the text, unless
  /// the link has ended for another reason before. Messages that were read already may still be
  /// reported.
  void close(const std::string& why);

 private:
  void on_refused(SessionId session) override;
  void on_connected(SessionId session, const std::optional<ChannelBinding>& binding) override;
  void on_message(SessionId session, Message&& message, std::size_t bytes) override;
  void on_drained(SessionId /*session*/) override {}
  void on_disconnected(SessionId session) override;
  void report_end();

  asio::io_context& io_;
  const asio::any_io_executor decoders_;
  const std::uint16_t chunk_edge_;
  const std::optional<TlsContext> tls_;
  // The session uses the next three. It shares the ownership of the link, which refers to it
  // weakly.
  NetLimits limits_;
  NetCounters counters_;
  ByteBudget no_budget_{0};
  std::weak_ptr<NetSession> session_;  // set by connect()
  std::atomic<bool> is_connected_{false};
  // Used on the strand of the session.
  Events events_;
  std::optional<Goodbye> goodbye_;  // of the server
};

}  // namespace runstone
