#include "server/web/web_gateway.hpp"

#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <utility>
// Boost 1.74 uses std::exchange without its header, so <utility> comes first.
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>
#include <optional>
#include <string_view>
#include <thread>

#include "common/os/host_port.hpp"
#include "server/web/rare_line.hpp"
#include "server/web/web_connection.hpp"
#include "server/web/web_log.hpp"

namespace runstone {
namespace {

using boost::asio::ip::tcp;

constexpr std::uint16_t kDefaultWebPort = 8080;
constexpr std::size_t kSocketNameBytesMax = sizeof(sockaddr_un::sun_path) - 1;
constexpr auto kSweepInterval = std::chrono::seconds(1);
// While the last connections end.
constexpr auto kStopInterval = std::chrono::milliseconds(20);

AddressBlock block_of(const boost::asio::ip::address& address) {
  return address.is_v6() ? address_block_v6(address.to_v6().to_bytes())
                         : address_block_v4(address.to_v4().to_uint());
}

/// Fails if the path of a server's socket is too long.
Result<void, std::string> check_socket_path(const std::string& path) {
  if (path.size() + std::string_view(".status").size() <= kSocketNameBytesMax) return {};
  return failure("gateway_socket = " + path + ": the path of a socket has at most " +
                 std::to_string(kSocketNameBytesMax) +
                 " bytes, with \".status\": use a shorter or a relative one");
}
/// Checks the paths of the sockets of all servers of the gateway.
Result<void, std::string> check_socket_paths(const WebConfig& config) {
  if (config.servers.empty()) return check_socket_path(config.gateway_socket);
  for (const WebServer& server : config.servers) {
    if (const auto checked = check_socket_path(server.gateway_socket); !checked) return checked;
  }
  return {};
}

/// Returns true if an accept failed because this process may open no more files. A connection that is
/// closed then makes room for another one. If the whole system is out of files or memory, that room
/// may go to another program, so no connection is closed for it.
bool is_out_of_files(const boost::system::error_code& error) {
  return error.value() == EMFILE && error.category() == boost::system::system_category();
}

}  // namespace

// Members are destroyed in reverse order. The sockets of the state and the acceptor need its
// io_context, which is in the state.
struct WebGateway::Parts {
  Parts(const WebConfig& config, ClientFiles client, OriginCheck origin, Certificate certificate)
      : state(config, std::move(client), std::move(origin), std::move(certificate)),
        acceptor(state.io),
        pause(state.io),
        sweep(state.io) {
    state.counters.certificate_ends_s = static_cast<std::uint64_t>(state.certificate.ends_s());
  }

  Result<void, std::string> listen();
  boost::asio::awaitable<void> accept_loop();
  boost::asio::awaitable<void> sweep_loop();
  void admit(tcp::socket socket);
  /// Makes room for one more connection, if there is none, with evict_oldest(). Returns false if that
  /// failed.
  bool make_room();
  /// Closes the oldest connection that is no WebSocket, or else the oldest WebSocket that has sent
  /// nothing. Returns false if there is none. `limit`: what the operator can change, for the log.
  bool evict_oldest(const char* limit);
  void reload_certificate();
  void stop();

  WebState state;
  tcp::acceptor acceptor;
  boost::asio::steady_timer pause, sweep;
  std::uint64_t next_id = 1;
  bool is_stopped = false;
  RareLine refusal_line, eviction_line, accept_line;
  std::uint16_t port = 0;
  const bool is_encrypted = state.certificate.is_there();
  std::thread thread;
};

Result<void, std::string> WebGateway::Parts::listen() {
  const auto cannot = [&](const std::string& why) {
    return failure("cannot listen on \"" + state.config.listen + "\": " + why);
  };
  const auto parsed = parse_listen_address(state.config.listen, kDefaultWebPort);
  if (!parsed) return cannot(parsed.error());
  boost::system::error_code error;
  tcp::resolver resolver(state.io);
  const auto ends =
      resolver.resolve(parsed->host, std::to_string(parsed->port),
                       tcp::resolver::passive | tcp::resolver::numeric_service, error);
  if (error) return cannot(error.message());
  const tcp::endpoint end = ends.begin()->endpoint();
  if (!state.certificate.is_there() && !state.config.i_know && !end.address().is_loopback()) {
    return cannot(
        "without a certificate the gateway is for this machine only, because everybody on the way "
        "could read and change what players send: set tls_certificate and tls_key, or listen on "
        "127.0.0.1");
  }
  if (!state.certificate.is_there() && state.config.operators_page &&
      !end.address().is_loopback()) {
    return cannot(
        "the page for operators (operators_page) needs a certificate, or an address of this machine: "
        "everybody on the way could act as an operator");
  }
  acceptor.open(end.protocol(), error);
  if (!error) acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(end, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (!error) acceptor.non_blocking(true, error);
  if (error) return cannot(error.message());
  port = acceptor.local_endpoint(error).port();
  return {};
}

boost::asio::awaitable<void> WebGateway::Parts::accept_loop() {
  while (acceptor.is_open()) {
    tcp::socket socket(state.io);
    boost::system::error_code error;
    // Linux fails for want of a file also if no connection is there, so the call waits for one first.
    co_await acceptor.async_wait(tcp::acceptor::wait_read,
                                 boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (!error) acceptor.accept(socket, error);
    if (error == boost::asio::error::would_block) continue;  // the browser has gone
    if (!error) {
      if (!is_stopped) admit(std::move(socket));
    } else if (acceptor.is_open()) {
      ++state.counters.accepts_failed;
      const bool is_full = is_out_of_files(error);
      accept_line.print(steady_now_us(), "cannot take a connection: " + error.message() +
                                             (is_full ? ": see ulimit -n and sockets_max" : ""));
      // New connections wait in the kernel meanwhile.
      if (is_full) evict_oldest("ulimit -n");
      pause.expires_after(std::chrono::milliseconds(100));
      co_await pause.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, error));
    }
  }
}

boost::asio::awaitable<void> WebGateway::Parts::sweep_loop() {
  // It goes on while the connections end after a stop.
  while (!is_stopped || !state.connections.empty()) {
    boost::system::error_code error;
    if (is_stopped) {
      sweep.expires_after(kStopInterval);
    } else {
      sweep.expires_after(kSweepInterval);
    }
    co_await sweep.async_wait(boost::asio::redirect_error(boost::asio::use_awaitable, error));
    const TimeUs now_us = steady_now_us();
    for (const auto& [id, connection] : state.connections) connection->close_if_due(now_us);
    if (!is_stopped && state.certificate.has_changed(now_us)) reload_certificate();
  }
}

void WebGateway::Parts::admit(tcp::socket socket) {
  ++state.counters.connections;
  boost::system::error_code ignored, gone;
  const boost::asio::ip::address address = socket.remote_endpoint(gone).address();
  if (gone) return;
  const AddressBlock from = block_of(address);
  const TimeUs now_us = steady_now_us();
  const char* limit = state.limits.try_add(from, now_us);
  if (limit == nullptr && !make_room()) {
    state.limits.remove(from);
    limit = "sockets_max";
  }
  if (limit != nullptr) {
    ++state.counters.refused;
    refusal_line.print(now_us, "a connection from " + address.to_string() +
                                   " is refused because of the setting " + limit);
    // A reset leaves nothing in the kernel. Otherwise each of these sockets would stay in TIME_WAIT.
    socket.set_option(boost::asio::socket_base::linger(true, 0), ignored);
    return;
  }
  auto connection = std::make_shared<WebConnection>(state, next_id++, std::move(socket), from);
  boost::asio::co_spawn(state.io, WebConnection::run(std::move(connection)), boost::asio::detached);
}

bool WebGateway::Parts::make_room() {
  if (state.connections.size() < state.config.sockets_max) return true;
  // Connections that are closed stay among the others until their coroutines have ended.
  const auto open = std::ranges::count_if(
      state.connections, [](const auto& each) { return !each.second->is_closed(); });
  return static_cast<std::size_t>(open) < state.config.sockets_max || evict_oldest("sockets_max");
}

bool WebGateway::Parts::evict_oldest(const char* limit) {
  WebConnection* silent = nullptr;
  WebConnection* oldest = nullptr;
  for (const auto& [id, connection] : state.connections) {
    if (connection->is_closed()) continue;
    if (!connection->is_websocket()) {
      oldest = connection;
      break;
    }
    if (silent == nullptr && connection->is_silent_websocket()) silent = connection;
  }
  if (oldest == nullptr) oldest = silent;
  if (oldest == nullptr) return false;
  eviction_line.print(steady_now_us(), "a connection from " + oldest->address() +
                                           " is closed to make room for a newer one: see " + limit);
  oldest->close();
  ++state.counters.evicted;
  return true;
}

void WebGateway::Parts::reload_certificate() {
  if (!state.certificate.is_there()) {
    log_web_line("there is no certificate to read again");
    return;
  }
  const auto done = state.certificate.reload();
  if (!done) {
    ++state.counters.certificates_refused;
    log_web_line("the new certificate is refused, and the old one stays: " + done.error());
    return;
  }
  ++state.counters.certificates_read;
  state.counters.certificate_ends_s = static_cast<std::uint64_t>(state.certificate.ends_s());
  log_web_line("new connections get the new certificate");
}

void WebGateway::Parts::stop() {
  is_stopped = true;
  boost::system::error_code ignored;
  acceptor.close(ignored);
  pause.cancel();
  sweep.cancel();
  for (const auto& [id, connection] : state.connections) connection->end_because_of_stop();
  for (const auto& world : state.worlds) world->map.stop();
}

WebGateway::WebGateway(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<WebGateway>, std::string> WebGateway::start(const WebConfig& config) {
  if (const auto checked = check_socket_paths(config); !checked) return failure(checked.error());
  auto origins = parse_origins(config.origins);
  if (!origins) return failure(origins.error());
  auto certificate = Certificate::read(config.tls_certificate, config.tls_key);
  if (!certificate) return failure(certificate.error());
  // The gateway starts nevertheless: it takes the next certificate as soon as the files have it.
  if (const auto invalid = certificate->fault())
    log_web_line("browsers will refuse to connect: " + *invalid);
  Result<ClientFiles, std::string> client = ClientFiles();
  if (!config.client_files.empty()) client = ClientFiles::load(config.client_files);
  if (!client) return failure("client_files: " + client.error());
  OriginCheck origin(*std::move(origins), certificate->is_there());
  auto parts = std::make_unique<Parts>(config, *std::move(client), std::move(origin),
                                       *std::move(certificate));
  if (const auto bound = parts->listen(); !bound) return failure(bound.error());
  Parts& running = *parts;
  boost::asio::co_spawn(running.state.io, running.accept_loop(), boost::asio::detached);
  boost::asio::co_spawn(running.state.io, running.sweep_loop(), boost::asio::detached);
  running.thread = std::thread([&running] { running.state.io.run(); });
  return std::unique_ptr<WebGateway>(new WebGateway(std::move(parts)));
}

WebGateway::~WebGateway() {
  boost::asio::post(parts_->state.io, [parts = parts_.get()] { parts->stop(); });
  parts_->thread.join();
}

std::uint16_t WebGateway::port() const { return parts_->port; }
bool WebGateway::is_encrypted() const { return parts_->is_encrypted; }
void WebGateway::reload_certificate() {
  boost::asio::post(parts_->state.io, [parts = parts_.get()] { parts->reload_certificate(); });
}

}  // namespace runstone
