#include "server/net/gateway_listener.hpp"

#include <sys/stat.h>
#include <sys/un.h>

#include <array>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/post.hpp>
#include <asio/read.hpp>
#include <cerrno>
#include <filesystem>
#include <span>
#include <utility>

#include "protocol/codec/proxy_header.hpp"
#include "server/net/await_tuple.hpp"
#include "server/net/net_log.hpp"

namespace runstone {
namespace {

using LocalProtocol = asio::local::stream_protocol;

constexpr std::size_t kSocketPathBytesMax = sizeof(sockaddr_un::sun_path) - 1;
// A gateway sends the header at once, so few connections wait for theirs. Further ones are closed.
constexpr std::size_t kGreetingsMax = 256;

asio::ip::tcp::endpoint endpoint_of(const PeerEndpoint& peer) {
  return {asio::ip::make_address_v6(peer.address), peer.port};
}

}  // namespace

struct GatewayListener::Greeting {
  Greeting(LocalProtocol::socket accepted, const Strand& strand)
      : socket(std::move(accepted)), deadline(strand) {}
  LocalProtocol::socket socket;
  asio::steady_timer deadline;
  std::array<std::uint8_t, kProxyHeaderBytesMax> header{};
};

Result<void, std::string> can_listen_at_path(const std::string& path) {
  if (path.size() > kSocketPathBytesMax) {
    return failure(path + ": a socket's path has at most " + std::to_string(kSocketPathBytesMax) +
                   " bytes: use a shorter or a relative one");
  }
  std::error_code ignored;
  const auto status = std::filesystem::symlink_status(path, ignored);
  if (!std::filesystem::exists(status)) return {};
  if (status.type() != std::filesystem::file_type::socket)
    return failure(path + ": this is a file, and a socket is to be made there");
  asio::io_context io;
  LocalProtocol::socket probe(io);
  asio::error_code error;
  probe.connect(LocalProtocol::endpoint(path), error);
  if (error == asio::error::connection_refused) return {};  // a crashed program has left it
  return failure(path + ": " +
                 (error ? "it cannot be tried: " + error.message()
                        : std::string("another program listens there")));
}

GatewayListener::GatewayListener(asio::io_context& io, std::chrono::milliseconds header_time,
                                 Admit admit)
    : io_(io),
      strand_(asio::make_strand(io)),
      acceptor_(strand_),
      pause_(strand_),
      header_time_(header_time),
      admit_(std::move(admit)) {}

Result<void, std::string> GatewayListener::listen(const std::string& path, bool is_for_group) {
  if (const auto can = can_listen_at_path(path); !can) return can;
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  asio::error_code error;
  acceptor_.open(LocalProtocol(), error);
  if (!error) acceptor_.bind(LocalProtocol::endpoint(path), error);
  // Nobody can connect before listen(), so the mode takes effect in time.
  const mode_t mode = S_IRUSR | S_IWUSR | (is_for_group ? S_IRGRP | S_IWGRP : 0);
  if (!error && ::chmod(path.c_str(), mode) != 0) {
    error = asio::error_code(errno, asio::error::get_system_category());
  }
  if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  if (error) return failure("cannot listen at " + path + ": " + error.message());
  path_ = path;
  return {};
}

void GatewayListener::start() {
  asio::co_spawn(strand_, accept_loop(shared_from_this()), asio::detached);
}

void GatewayListener::stop() {
  asio::post(strand_, [self = shared_from_this()] {
    asio::error_code ignored;
    std::error_code gone;
    // The file goes first: after the close, another server may have made its own.
    if (!self->path_.empty()) std::filesystem::remove(self->path_, gone);
    self->path_.clear();
    self->acceptor_.close(ignored);
    self->pause_.cancel();
    for (const auto& greeting : self->greetings_) greeting->socket.close(ignored);
  });
}

asio::awaitable<void> GatewayListener::accept_loop(std::shared_ptr<GatewayListener> self) {
  while (self->acceptor_.is_open()) {
    LocalProtocol::socket socket(self->io_);
    const auto [error] = co_await self->acceptor_.async_accept(socket, kTuple);
    if (!error) {
      if (self->greetings_.size() >= kGreetingsMax) continue;
      auto greeting = std::make_shared<Greeting>(std::move(socket), self->strand_);
      self->greetings_.insert(greeting);
      asio::co_spawn(self->strand_, read_header(self, std::move(greeting)), asio::detached);
    } else if (self->acceptor_.is_open()) {
      // The process is probably out of file descriptors. Sessions that end release some.
      self->pause_.expires_after(std::chrono::milliseconds(100));
      const auto [woken] = co_await self->pause_.async_wait(kTuple);
      (void)woken;
    }
  }
}

asio::awaitable<void> GatewayListener::read_header(std::shared_ptr<GatewayListener> self,
                                                   std::shared_ptr<Greeting> greeting) {
  greeting->deadline.expires_after(self->header_time_);
  greeting->deadline.async_wait([greeting](const asio::error_code& cancelled) {
    asio::error_code ignored;
    if (!cancelled) greeting->socket.close(ignored);
  });
  std::string why = "its PROXY header did not come";
  const std::span<std::uint8_t> header(greeting->header);
  const auto [error, read] = co_await asio::async_read(
      greeting->socket, asio::buffer(header.data(), kProxyPrefixBytes), kTuple);
  (void)read;
  const auto bytes = proxy_header_bytes(header.first(kProxyPrefixBytes));
  if (!error && bytes) {
    const auto rest = header.subspan(kProxyPrefixBytes, *bytes - kProxyPrefixBytes);
    const auto [cut, got] =
        co_await asio::async_read(greeting->socket, asio::buffer(rest.data(), rest.size()), kTuple);
    (void)got;
    const auto parsed = read_proxy_header(header.first(*bytes));
    if (!cut && parsed) {
      why.clear();
      greeting->deadline.cancel();
      // A connection of the gateway itself pays as this machine.
      const PeerEndpoint client = parsed->client.value_or(peer_endpoint_v4(0x7f000001, 0));
      self->admit_(std::move(greeting->socket), endpoint_of(client));
    } else if (!cut) {
      why = parsed.error().what;
    }
  } else if (!error) {
    why = bytes.error().what;
  }
  self->greetings_.erase(greeting);
  greeting->deadline.cancel();
  if (!why.empty()) log_refused_gateway(why);
}

}  // namespace runstone
