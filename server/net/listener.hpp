// Listener: accepts connections and keeps the sessions by number. Sockets that never authenticate keep nobody
// out: a newcomer for whom there is no room takes the place of the oldest one in the handshake, and one
// address has few of those. Threads: the accept loop runs on its own strand; the others but listen() may be
// called from any thread.
#pragma once
#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "server/net/net_session.hpp"

namespace runstone {

/// Whether Listener::listen() would succeed now: binds and lets go again. The error is the same line.
Result<void, std::string> can_listen(const std::string& address);

class Listener : public std::enable_shared_from_this<Listener> {
 public:
  /// `events` must outlive the io_context's threads.
  Listener(asio::io_context& io, const NetLimits& limits, std::uint16_t chunk_edge,
           NetEvents& events);

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
  /// The session has authenticated: its connection is not closed for a newcomer any more.
  void opened(SessionId session);
  /// Forgets a session that has told disconnected.
  void forget(SessionId session);
  std::size_t session_count() const;
  void close_all(GoodbyeReason reason, const std::string& text);
  const NetCounters& counters() const { return counters_; }

 private:
  static asio::awaitable<void> accept_loop(std::shared_ptr<Listener> self);
  void admit(asio::ip::tcp::socket socket);
  /// Sessions that have to go so that one more from `from` fits; nothing if it cannot. Under the mutex.
  std::optional<std::vector<std::shared_ptr<NetSession>>> make_room(const asio::ip::address& from);
  void end_handshake(SessionId session);

  asio::io_context& io_;
  const NetLimits limits_;
  ByteBudget budget_;  // of all sessions
  const std::uint16_t chunk_edge_;
  NetEvents& events_;
  NetCounters counters_;
  asio::strand<asio::any_io_executor> strand_;
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  std::uint16_t port_ = 0;
  SessionId next_id_ = 1;
  mutable std::mutex mutex_;  // a leaf: guards the rest
  std::map<SessionId, std::shared_ptr<NetSession>> sessions_;
  std::map<SessionId, asio::ip::address>
      handshakes_;  // oldest first: neither authenticated nor told to go
  std::map<asio::ip::address, std::set<SessionId>>
      handshakes_from_;          // the same by address, never empty sets
  std::set<SessionId> leaving_;  // told to go, still in `sessions_`
};

}  // namespace runstone
