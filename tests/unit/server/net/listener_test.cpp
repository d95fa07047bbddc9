#include "server/net/listener.hpp"

#include <array>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

using namespace runstone;
using asio::ip::tcp;

namespace {

struct IgnoredEvents final : NetEvents {
  explicit IgnoredEvents(std::shared_ptr<Listener>& listener_) : listener(listener_) {}
  void on_refused(SessionId session) override { listener->forget(session); }
  void on_connected(SessionId /*session*/,
                    const std::optional<ChannelBinding>& /*binding*/) override {}
  void on_message(SessionId /*session*/, Message&& /*message*/, std::size_t /*bytes*/) override {}
  void on_drained(SessionId /*session*/) override {}
  void on_disconnected(SessionId session) override { listener->forget(session); }
  std::shared_ptr<Listener>& listener;
};

/// A listener whose threads work only when the test lets them.
struct ListenerBench {
  explicit ListenerBench(const NetLimits& limits) {
    constexpr std::array<std::uint8_t, 32> kSeed{1, 2, 3};
    listener = std::make_shared<Listener>(io, handshakes.get_executor(), limits, std::uint16_t{32},
                                          events);
    listener->set_tls(TlsContext::self_signed_server(kSeed));
    REQUIRE(listener->listen("127.0.0.1:0").has_value());
    listener->start();
  }
  ~ListenerBench() {
    listener->stop();
    listener->close_all(GoodbyeReason::closing, "the test ends");
    while (listener->session_count() > 0) work();
    work();
  }
  /// Connects and sends what makes the server work on a handshake.
  void connect() {
    tcp::socket client(clients);
    client.connect({asio::ip::address_v4::loopback(), listener->port()});
    constexpr std::array<std::uint8_t, 5> kRecord{22, 3, 1, 0, 100};
    client.write_some(asio::buffer(kRecord));
    sockets.push_back(std::move(client));
    const std::uint64_t before = decided();
    while (decided() == before) io.run_one();
    for (int i = 0; i < 10; ++i) io.poll();
  }
  /// Returns how many connections were accepted or refused. One that makes another leave counts
  /// twice.
  std::uint64_t decided() const {
    return listener->counters().connections + listener->counters().refused;
  }
  void work() {
    handshakes.restart();
    handshakes.poll();
    io.restart();
    io.poll();
  }
  asio::io_context io, handshakes, clients;
  std::shared_ptr<Listener> listener;
  IgnoredEvents events{listener};
  std::vector<tcp::socket> sockets;
};

}  // namespace

TEST_CASE("connections that were ended count until their threads have let go of them", "[net]") {
  NetLimits limits;
  limits.connections_max = 10;
  limits.handshakes_per_address = 1'000;
  ListenerBench bench(limits);
  for (int i = 0; i < 200; ++i) bench.connect();
  // Ten in the handshake and 64 that were ended. The others were refused at once.
  CHECK(bench.listener->session_count() == 10 + 64);
  CHECK(bench.listener->counters().connections == 10 + 64);
  for (int i = 0; i < 1'000 && bench.listener->session_count() > 10; ++i) bench.work();
  CHECK(bench.listener->session_count() == 10);
  bench.connect();
  CHECK(bench.listener->counters().connections == 10 + 64 + 1);
}
