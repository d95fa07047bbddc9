#include <netinet/tcp.h>
#include <openssl/ssl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "bench/network/descriptor.hpp"
#include "bench/servers/fan_out_senders.hpp"
#include "bench/servers/receivers.hpp"
#include "common/core/assert.hpp"
#include "common/core/bytes.hpp"
#include "common/os/thread_cpu_ns.hpp"
#include "common/tls/openssl_ptr.hpp"
#include "common/tls/tls_context.hpp"
#include "protocol/codec/frame.hpp"
#include "tests/support/tls/ipv4_socket.hpp"

namespace runstone::bench {
namespace {

using SslPtr = OpensslPtr<SSL, SSL_free>;
constexpr std::array<std::uint8_t, 32> kFloorSeed{1};

/// A connection that the floor accepted, with its encryption if there is one.
struct Accepted {
  Descriptor socket;
  SslPtr tls;

  /// Writes all bytes. The socket is blocking: while it is full, the thread waits and uses no
  /// processor time. Aborts if the receiver closed the connection.
  void write(ByteView bytes) const {
    while (!bytes.empty()) {
      const auto wrote =
          tls ? std::int64_t{SSL_write(tls.get(), bytes.data(), static_cast<int>(bytes.size()))}
              : std::int64_t{::send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL)};
      RUNSTONE_ASSERT(wrote > 0);
      bytes = bytes.subspan(static_cast<std::size_t>(wrote));
    }
  }
};

class FloorSender final : public FanOutSender {
 public:
  explicit FloorSender(bool is_encrypted) {
    if (is_encrypted) context_.emplace_back(TlsContext::self_signed_server(kFloorSeed));
  }

  /// Accepts the receivers, which connect meanwhile.
  Result<void, std::string> connect(const FanOutSize& size) {
    const Descriptor listening(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    sockaddr_in here = test::ipv4_endpoint(INADDR_LOOPBACK, 0);
    socklen_t bytes = sizeof here;
    auto* const address = reinterpret_cast<sockaddr*>(&here);
    if (::bind(listening.get(), address, bytes) != 0 || ::listen(listening.get(), 64) != 0 ||
        ::getsockname(listening.get(), address, &bytes) != 0) {
      return failure(std::string("cannot listen: ") + std::strerror(errno));
    }
    receivers_ =
        std::make_unique<Receivers>(ntohs(here.sin_port), size.receivers, size.is_encrypted);
    while (accepted_.size() < size.receivers) {
      constexpr int kWaitMs = 10'000;
      if (!test::wait_input(listening.get(), kWaitMs)) return failure("a receiver did not connect");
      Accepted one;
      one.socket = Descriptor(::accept4(listening.get(), nullptr, nullptr, SOCK_CLOEXEC));
      if (!one.socket) return failure(std::string("cannot accept: ") + std::strerror(errno));
      const int no_delay = 1;
      ::setsockopt(one.socket.get(), IPPROTO_TCP, TCP_NODELAY, &no_delay, sizeof no_delay);
      if (!context_.empty()) {
        one.tls.reset(SSL_new(context_.front().get()));
        SSL_set_fd(one.tls.get(), one.socket.get());
        if (SSL_accept(one.tls.get()) != 1) return failure("a TLS handshake failed");
      }
      accepted_.push_back(std::move(one));
    }
    return receivers_->wait();
  }

  std::int64_t send_to_all(std::size_t body_bytes) override {
    text_.assign(kFrameHeaderBytes + body_bytes, 1);
    const std::int64_t began_ns = thread_cpu_ns();
    for (const Accepted& one : accepted_) one.write(text_);
    return thread_cpu_ns() - began_ns;
  }

 private:
  std::vector<TlsContext> context_;  // one, or none
  std::vector<Accepted> accepted_;
  std::unique_ptr<Receivers> receivers_;
  Bytes text_;
};

}  // namespace

Result<std::unique_ptr<FanOutSender>, std::string> make_floor_sender(const FanOutSize& size) {
  auto sender = std::make_unique<FloorSender>(size.is_encrypted);
  if (const auto connected = sender->connect(size); !connected) return failure(connected.error());
  return std::unique_ptr<FanOutSender>(std::move(sender));
}

}  // namespace runstone::bench
