// Listener: accepts connections and keeps the sessions by number.
// Threads: the accept loop runs on its own strand; find() and close_all() may be called from any thread.
#pragma once
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "common/core/result.hpp"
#include "server/net/net_session.hpp"

namespace runstone {

/// Whether Listener::listen() would succeed now: binds and lets go again. The error is the same line.
Result<void, std::string> can_listen(const std::string& address);

class Listener : public std::enable_shared_from_this<Listener> {
 public:
  /// `events` must outlive the io_context's threads.
  Listener(asio::io_context& io, const NetLimits& limits, std::uint16_t chunk_edge, NetEvents& events);

  /// Binds and listens. `address` is "HOST:PORT" or "[V6]:PORT"; port 0 takes a free one. The error is one
  /// line that names the address.
  Result<void, std::string> listen(const std::string& address);
  std::uint16_t port() const { return port_; }
  /// Accepts from now on.
  void start();
  /// Takes no more connections.
  void stop();

  /// Null if it is gone.
  std::shared_ptr<NetSession> find(SessionId session) const;
  /// Forgets a session that has told disconnected.
  void forget(SessionId session);
  std::size_t session_count() const;
  void close_all(GoodbyeReason reason, const std::string& text);
  const NetCounters& counters() const { return counters_; }

 private:
  static asio::awaitable<void> accept_loop(std::shared_ptr<Listener> self);
  void admit(asio::ip::tcp::socket socket);

  asio::io_context& io_;
  const NetLimits limits_;
  const std::uint16_t chunk_edge_;
  NetEvents& events_;
  NetCounters counters_;
  asio::strand<asio::any_io_executor> strand_;
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::uint16_t port_ = 0;
  SessionId next_id_ = 1;
  mutable std::mutex mutex_;  // a leaf: guards the map
  std::map<SessionId, std::shared_ptr<NetSession>> sessions_;
};

}  // namespace runstone
