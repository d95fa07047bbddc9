#include "bench/servers/receivers.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "common/tls/socket_source.hpp"
#include "common/tls/tls_channel.hpp"
#include "common/tls/tls_context.hpp"
#include "tests/support/tls/ipv4_socket.hpp"
#include "tests/support/tls/tls_client.hpp"

namespace runstone::bench {

Receivers::Receivers(std::uint16_t port, std::size_t count, bool is_encrypted)
    : port_(port), count_(count), is_encrypted_(is_encrypted), thread_([this] { run(); }) {}

Receivers::~Receivers() {
  is_over_ = true;
  thread_.join();
}

Result<void, std::string> Receivers::wait() const {
  while (!is_connected_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (!failure_.empty()) return failure(failure_);
  return {};
}

void Receivers::run() {
  while (sockets_.size() < count_ && !is_over_ && connect()) {
  }
  is_connected_ = true;
  if (failure_.empty()) read_all();
}

bool Receivers::connect() {
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const sockaddr_in there = test::ipv4_endpoint(INADDR_LOOPBACK, port_);
  if (!socket ||
      ::connect(socket.get(), reinterpret_cast<const sockaddr*>(&there), sizeof there) != 0) {
    failure_ = std::string("cannot connect a receiver: ") + std::strerror(errno);
    return false;
  }
  if (is_encrypted_) {
    SocketSource source;
    if (!test::connect_tls(socket.get(), source, TlsContext::client(), "127.0.0.1")) {
      failure_ = "a receiver's TLS handshake failed";
      return false;
    }
  }
  sockets_.push_back(std::move(socket));
  return true;
}

void Receivers::read_all() {
  const Descriptor poll(::epoll_create1(EPOLL_CLOEXEC));
  for (const Descriptor& socket : sockets_) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = socket.get();
    ::epoll_ctl(poll.get(), EPOLL_CTL_ADD, socket.get(), &event);
  }
  std::vector<char> buffer(64 * 1024);
  std::array<epoll_event, 256> events{};
  while (!is_over_) {
    constexpr int kWaitMs = 10;
    const int count =
        ::epoll_wait(poll.get(), events.data(), static_cast<int>(events.size()), kWaitMs);
    for (int i = 0; i < count; ++i) {
      const int socket = events[static_cast<std::size_t>(i)].data.fd;
      const ssize_t got = ::recv(socket, buffer.data(), buffer.size(), MSG_DONTWAIT);
      if (got == 0) ::epoll_ctl(poll.get(), EPOLL_CTL_DEL, socket, nullptr);  // the sender ended
    }
  }
}

}  // namespace runstone::bench
