// GatewayListener: accepts connections of a gateway on this machine, such as runstone-web, at a
// Unix socket. Each of them speaks for one client and begins with a PROXY header, which names the
// client's address. Nobody else can reach the socket, because the file's mode keeps other users
// out; a header over TCP would let every client choose its address.
// Threads: everything runs on a strand of the I/O context; the functions may be called from any
// thread. listen() is called before start().
#pragma once
#include <asio/awaitable.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/local/stream_protocol.hpp>
#include <asio/steady_timer.hpp>
#include <asio/strand.hpp>
#include <chrono>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "common/core/result.hpp"

namespace runstone {

/// Returns an error if no socket can be made at this path: it is too long for a socket, it is a
/// file of another kind, or a running program listens there.
Result<void, std::string> can_listen_at_path(const std::string& path);

class GatewayListener : public std::enable_shared_from_this<GatewayListener> {
 public:
  /// Takes over a connection for the client at this endpoint. Called on the strand.
  using Admit =
      std::function<void(asio::local::stream_protocol::socket, const asio::ip::tcp::endpoint&)>;

  /// A connection whose header is not complete after `header_time` is closed.
  GatewayListener(asio::io_context& io, std::chrono::milliseconds header_time, Admit admit);

  /// Makes the socket's file with the mode 0600, or 0660 if the file's group may connect as well. A
  /// file that a crashed server has left is replaced. The error names the path.
  Result<void, std::string> listen(const std::string& path, bool is_for_group);
  void start();
  /// Accepts no more connections, closes those whose header has not come, and removes the file.
  void stop();

 private:
  using Strand = asio::strand<asio::io_context::executor_type>;
  struct Greeting;  // a connection whose header has not come yet

  static asio::awaitable<void> accept_loop(std::shared_ptr<GatewayListener> self);
  static asio::awaitable<void> read_header(std::shared_ptr<GatewayListener> self,
                                           std::shared_ptr<Greeting> greeting);

  asio::io_context& io_;
  Strand strand_;
  asio::local::stream_protocol::acceptor acceptor_;
  asio::steady_timer pause_;
  const std::chrono::milliseconds header_time_;
  const Admit admit_;
  std::string path_;                               // empty: not listening
  std::set<std::shared_ptr<Greeting>> greetings_;  // on the strand
};

}  // namespace runstone
