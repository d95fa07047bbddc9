#include "server/web/web_gateway.hpp"

#include <sys/stat.h>
#include <sys/un.h>

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
#include <filesystem>
#include <thread>
#include <vector>

#include "common/os/host_port.hpp"
#include "server/web/web_connection.hpp"

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

Result<std::optional<boost::asio::ssl::context>, std::string> read_certificate(
    const WebConfig& config) {
  std::optional<boost::asio::ssl::context> out;
  if (config.tls_certificate.empty() != config.tls_key.empty())
    return failure("tls_certificate and tls_key: one of them is missing");
  if (config.tls_key.empty()) return out;
  struct stat about{};
  if (::stat(config.tls_key.c_str(), &about) == 0 && (about.st_mode & S_IROTH) != 0) {
    return failure("tls_key = \"" + config.tls_key +
                   "\": every user of this machine can read the secret key: chmod o-r it");
  }
  out.emplace(boost::asio::ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(out->native_handle(), TLS1_3_VERSION);
  // Neither ended sessions nor idle connections keep memory.
  SSL_CTX_set_session_cache_mode(out->native_handle(), SSL_SESS_CACHE_OFF);
  SSL_CTX_set_mode(out->native_handle(), SSL_MODE_RELEASE_BUFFERS);
  boost::system::error_code error;
  out->use_certificate_chain_file(config.tls_certificate, error);
  if (error)
    return failure("tls_certificate = \"" + config.tls_certificate + "\": " + error.message());
  out->use_private_key_file(config.tls_key, boost::asio::ssl::context::pem, error);
  if (error) return failure("tls_key = \"" + config.tls_key + "\": " + error.message());
  return out;
}

}  // namespace

// Members are destroyed in reverse order. The sockets of the state and the acceptor need its
// io_context, which is in the state.
struct WebGateway::Parts {
  Parts(const WebConfig& config, ClientFiles client, OriginCheck origin,
        std::optional<boost::asio::ssl::context> certificate)
      : state(config, std::move(client), std::move(origin), std::move(certificate)),
        acceptor(state.io),
        pause(state.io),
        sweep(state.io) {}

  Result<void, std::string> listen();
  boost::asio::awaitable<void> accept_loop();
  boost::asio::awaitable<void> sweep_loop();
  void admit(tcp::socket socket);
  /// Makes room for one more connection by closing the oldest one that is no WebSocket. Returns
  /// false if there is none.
  bool make_room();
  void stop();

  WebState state;
  tcp::acceptor acceptor;
  boost::asio::steady_timer pause, sweep;
  std::uint64_t next_id = 1;
  bool is_stopped = false;
  std::uint16_t port = 0;
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
  if (!state.tls && !state.config.i_know && !end.address().is_loopback()) {
    return cannot(
        "without a certificate the gateway is for this machine only, because everybody on the way "
        "could read and change what players send: set tls_certificate and tls_key, or listen on "
        "127.0.0.1");
  }
  acceptor.open(end.protocol(), error);
  if (!error) acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(end, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  if (error) return cannot(error.message());
  port = acceptor.local_endpoint(error).port();
  return {};
}

boost::asio::awaitable<void> WebGateway::Parts::accept_loop() {
  while (acceptor.is_open()) {
    tcp::socket socket(state.io);
    boost::system::error_code error;
    co_await acceptor.async_accept(socket,
                                   boost::asio::redirect_error(boost::asio::use_awaitable, error));
    if (!error) {
      if (!is_stopped) admit(std::move(socket));
    } else if (acceptor.is_open()) {
      // The process is probably out of file descriptors. Connections that end release some.
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
  }
}

void WebGateway::Parts::admit(tcp::socket socket) {
  ++state.counters.connections;
  boost::system::error_code ignored, gone;
  const AddressBlock from = block_of(socket.remote_endpoint(gone).address());
  if (gone) return;
  const bool has_room = state.limits.add(from, steady_now_us());
  if (!has_room || !make_room()) {
    if (has_room) state.limits.remove(from);
    ++state.counters.refused;
    // A reset leaves nothing in the kernel. Otherwise each of these sockets would stay in TIME_WAIT.
    socket.set_option(boost::asio::socket_base::linger(true, 0), ignored);
    return;
  }
  auto connection = std::make_shared<WebConnection>(state, next_id++, std::move(socket), from);
  boost::asio::co_spawn(state.io, WebConnection::run(std::move(connection)), boost::asio::detached);
}

bool WebGateway::Parts::make_room() {
  if (state.connections.size() < state.config.sockets_max) return true;
  for (const auto& [id, connection] : state.connections) {
    if (connection->is_websocket() || connection->is_closed()) continue;
    connection->close();
    ++state.counters.refused;
    return true;
  }
  return false;
}

void WebGateway::Parts::stop() {
  is_stopped = true;
  boost::system::error_code ignored;
  acceptor.close(ignored);
  pause.cancel();
  sweep.cancel();
  for (const auto& [id, connection] : state.connections) connection->end_because_of_stop();
  state.map.stop();
}

WebGateway::WebGateway(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Result<std::unique_ptr<WebGateway>, std::string> WebGateway::start(const WebConfig& config) {
  if (config.gateway_socket.size() + std::string_view(".status").size() > kSocketNameBytesMax) {
    return failure("gateway_socket = " + config.gateway_socket +
                   ": the path of a socket has at most " + std::to_string(kSocketNameBytesMax) +
                   " bytes, with \".status\": use a shorter or a relative one");
  }
  auto origins = parse_origins(config.origins);
  if (!origins) return failure(origins.error());
  auto certificate = read_certificate(config);
  if (!certificate) return failure(certificate.error());
  Result<ClientFiles, std::string> client = ClientFiles();
  if (!config.client_files.empty()) client = ClientFiles::load(config.client_files);
  if (!client) return failure("client_files: " + client.error());
  OriginCheck origin(*std::move(origins), certificate->has_value());
  auto parts = std::make_unique<Parts>(config, *std::move(client), std::move(origin),
                                       std::move(certificate).value());
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
bool WebGateway::is_encrypted() const { return parts_->state.tls.has_value(); }

}  // namespace runstone
