// Listener: accepts connections and keeps the sessions by number. Sockets that never authenticate
// cannot keep players out: if there is no room for a new connection, it replaces the oldest one in
// the handshake, and one address may have only handshakes_per_address of those. An address that
// connects more often than connections_per_second is refused before any handshake.
// Threads: the accept loop runs on its own strand. listen() is called before start(); the other
// functions may be called from any thread.
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
#include "server/limits/address_ledger.hpp"
#include "server/net/net_session.hpp"
#include "server/net/send_round.hpp"

namespace runstone {

/// Binds the address, releases it and returns it. Fails as Listener::listen() would.
Result<asio::ip::address, std::string> can_listen(const std::string& address);

class Listener : public std::enable_shared_from_this<Listener> {
 public:
  /// `events` and the threads of `decoders` must outlive the threads of `io`. The connections are
  /// not encrypted unless set_tls() is called.
  Listener(asio::io_context& io, asio::any_io_executor decoders, const NetLimits& limits,
           std::uint16_t chunk_edge, NetEvents& events);

  /// Binds and listens. `address` is of a form that parse_listen_address() reads; port 0 takes a
  /// free one. The error is one line that names the address.
  Result<void, std::string> listen(const std::string& address);
  std::uint16_t port() const { return port_; }
  /// Encrypts the connections that are accepted from now on.
  void set_tls(const TlsContext& tls);
  /// Starts to accept connections.
  void start();
  /// Accepts no more connections.
  void stop();
  /// Treats a connection that somebody else accepted like one of its own: the same limits hold for
  /// its address. If there is no room, it is closed. Requires start(). Thread: any.
  void admit(std::unique_ptr<ByteStream> stream);

  /// Returns null if there is no such session.
  std::shared_ptr<NetSession> find(SessionId session) const;
  /// Reports that the session has authenticated. Its connection is not replaced by a new one any
  /// more.
  void opened(SessionId session);
  /// Removes a session that has reported on_disconnected() or on_refused(). If its client broke a
  /// rule, its address is charged for connections_per_second further connections. So an address
  /// whose clients break rules gets about one connection a second.
  void forget(SessionId session);
  std::size_t session_count() const;
  /// Closes the sessions that have been writing the same bytes for so long: their clients do not
  /// read. Cost: O(sessions).
  void close_stalled(TimeUs now_us, TimeUs us_max);
  /// Closes all sessions and adds no more.
  void close_all(GoodbyeReason reason, const std::string& text);
  const NetCounters& counters() const { return counters_; }
  /// Returns the round that sends this message. The listener must outlive its tasks.
  SendRound begin_round(const EncodedMessage& message);

 private:
  // A closed session keeps its memory while a thread still works for it. While there are so many,
  // no connection is accepted.
  static constexpr std::size_t kLeavingMax = 64;

  static asio::awaitable<void> accept_loop(std::shared_ptr<Listener> self);
  void admit_socket(asio::ip::tcp::socket socket);
  /// Returns true if one more connection from this address may be added. It then has paid for it,
  /// and others that it replaces are being closed.
  bool make_place(AddressBlock from);
  /// Adds a connection for which there is a place.
  void add(std::unique_ptr<ByteStream> stream, AddressBlock from);
  /// Closes a connection that was accepted just now.
  void refuse(asio::ip::tcp::socket& socket);
  std::unique_ptr<ByteStream> make_stream(asio::ip::tcp::socket socket);
  /// Returns the budget of reading that the sessions of this address share.
  std::shared_ptr<ByteBudget> reads_of(AddressBlock from);
  /// Returns the sessions that must be closed so that one more from `from` fits, or nullopt if it
  /// cannot fit. Requires the mutex.
  std::optional<std::vector<std::shared_ptr<NetSession>>> make_room(AddressBlock from);
  void end_handshake(SessionId session);

  asio::io_context& io_;
  const asio::any_io_executor decoders_;
  const NetLimits limits_;
  ByteBudget budget_;  // of all sessions
  const std::uint16_t chunk_edge_;
  NetEvents& events_;
  NetCounters counters_;
  asio::strand<asio::any_io_executor> strand_;
  asio::ip::tcp::acceptor acceptor_;
  asio::steady_timer pause_;
  // The next two are used on the strand. A budget of reading lives as long as a session that uses
  // it.
  AddressLedger connections_;
  std::map<AddressBlock, std::weak_ptr<ByteBudget>> reads_;
  std::uint16_t port_ = 0;
  SessionId next_id_ = 1;
  mutable std::mutex mutex_;  // a leaf: guards the members below
  bool is_stopped_ = false;   // no session may be added
  std::optional<TlsContext> tls_;
  std::map<SessionId, std::shared_ptr<NetSession>> sessions_;
  // Sessions in the handshake that are not being closed, oldest first.
  std::map<SessionId, AddressBlock> handshakes_;
  // The same by address. No set is empty.
  std::map<AddressBlock, std::set<SessionId>> handshakes_from_;
  // Sessions that are being closed and are still in `sessions_`.
  std::set<SessionId> leaving_;
};

}  // namespace runstone
