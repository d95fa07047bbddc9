// The testbed's links with real sockets: what is sent arrives, not earlier than the profile allows.
// No test checks how much later.
#include "bench/network/testbed_link.hpp"

#include <array>
#include <asio/buffer.hpp>
#include <asio/io_context.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/read.hpp>
#include <asio/write.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include "bench/network/child.hpp"
#include "common/core/hash.hpp"
#include "tests/support/core/temp_folder.hpp"

using namespace runstone;
using namespace runstone::bench;
using asio::ip::tcp;

namespace {

constexpr test::LinkProfile kSlow{"slow", 20'000'000, 2'000'000, 50'000'000, 0};

/// Sends everything back that it reads, until its peer ends.
class EchoServer {
 public:
  EchoServer(Place& place, const std::string& address) {
    place.run([&] { acceptor_.emplace(io_, tcp::endpoint(asio::ip::make_address(address), 0)); });
    thread_ = std::thread([this] {
      tcp::socket socket = acceptor_->accept();
      asio::error_code error;
      std::array<char, 4096> buffer;
      for (;;) {
        const std::size_t got = socket.read_some(asio::buffer(buffer), error);
        if (error) return;
        asio::write(socket, asio::buffer(buffer, got), error);
      }
    });
  }
  ~EchoServer() { thread_.join(); }
  std::uint16_t port() const { return acceptor_->local_endpoint().port(); }

 private:
  asio::io_context io_;
  std::optional<tcp::acceptor> acceptor_;
  std::thread thread_;
};

/// Sends so many bytes through the link at once, checks what comes back, and returns the time in
/// ms.
double trip_ms(TestbedLink& link, std::size_t bytes) {
  EchoServer server(link.server_side(), link.server_address());
  const auto port = link.entrance(server.port());
  REQUIRE(port.has_value());
  asio::io_context io;
  tcp::socket socket(io);
  link.client_side().run([&] { socket.open(tcp::v4()); });
  socket.connect({asio::ip::make_address(link.server_address()), *port});
  socket.set_option(tcp::no_delay(true));
  std::vector<std::uint8_t> sent(bytes), back(bytes);
  SplitMix64 random(bytes);
  for (std::uint8_t& byte : sent) byte = static_cast<std::uint8_t>(random.below(256));
  // Twice: a connection through a proxy is open before its other half is.
  double ms = 0;
  for (int i = 0; i < 2; ++i) {
    const auto start = std::chrono::steady_clock::now();
    std::thread writer([&] { asio::write(socket, asio::buffer(sent)); });
    asio::read(socket, asio::buffer(back));
    ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    writer.join();
    CHECK(back == sent);
  }
  socket.close();
  return ms;
}

void check_link(const test::LinkProfile& profile, LinkKind kind) {
  auto link = TestbedLink::make(profile, kind, 1);
  INFO((link ? std::string() : link.error()));
  REQUIRE(link.has_value());
  CHECK((*link)->kind() == kind);
  CHECK(trip_ms(**link, 100) >= 16);  // a round trip minus twice the jitter
  const std::size_t many = 250'000;   // 40 ms at the link's rate
  CHECK(trip_ms(**link, many) >= 16 + 40);
  const auto counts = (*link)->stop();
  REQUIRE(counts.has_value() == (kind == LinkKind::namespaces));
  if (!counts) return;
  CHECK(counts->to_client.bytes > 2 * many);
  CHECK(counts->to_server.bytes > 2 * many);
  CHECK(counts->refused == 0);
}

}  // namespace

TEST_CASE("a shaper delays and slows bytes, and changes none", "[testbed]") {
  check_link(kSlow, LinkKind::shaper);
}

TEST_CASE("a segment that a shaper loses arrives later, and none is missing", "[testbed]") {
  auto link = TestbedLink::make({"lossy", 10'000'000, 0, 0, 0.2}, LinkKind::shaper, 1);
  REQUIRE(link.has_value());
  CHECK(trip_ms(**link, 200'000) >= 20);
}

TEST_CASE("namespaces joined by a link delay and slow packets, and leave nothing behind",
          "[testbed]") {
  const std::string why = why_no_namespaces();
  if (!why.empty()) {
    WARN("skipped: " + why);
    return;
  }
  const auto devices = [] {
    std::set<std::string> out;
    for (const auto& device : std::filesystem::directory_iterator("/sys/class/net"))
      out.insert(device.path());
    return out;
  };
  const auto before = devices();
  check_link(kSlow, LinkKind::namespaces);
  CHECK(devices() == before);
}

TEST_CASE("namespaces lose packets, and TCP sends them again", "[testbed]") {
  if (!why_no_namespaces().empty()) {
    WARN("skipped: " + why_no_namespaces());
    return;
  }
  auto link = TestbedLink::make({"lossy", 1'000'000, 0, 0, 0.05}, LinkKind::namespaces, 1);
  REQUIRE(link.has_value());
  CHECK(trip_ms(**link, 500'000) >= 1);
  CHECK((*link)->stop()->to_client.lost > 0);
}

TEST_CASE("a program runs where it was started, and its output is kept", "[testbed]") {
  const test::TempFolder folder;
  const auto run = [&](Place& place, const std::string& what) {
    const std::string log = folder / "log";
    std::filesystem::remove(log);
    auto child = Child::start(place, {"/bin/sh", "-c", what}, log);
    REQUIRE(child.has_value());
    CHECK((*child)->wait(30) == 0);
    std::ifstream in(log);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  const auto here = Place::here();
  CHECK(run(*here, "echo out; echo err >&2") == "out\nerr\n");
  CHECK_FALSE(Child::start(*here, {"/no/such/program"}, folder / "log").has_value());
  auto slow = Child::start(*here, {"/bin/sh", "-c", "sleep 100"}, folder / "log");
  REQUIRE(slow.has_value());
  CHECK_FALSE((*slow)->wait(0.05));
  CHECK((*slow)->resident_bytes() > 0);
  (*slow)->terminate();
  CHECK((*slow)->wait(30));
  if (!why_no_namespaces().empty()) return;
  auto link = TestbedLink::make(kSlow, LinkKind::namespaces, 1);
  REQUIRE(link.has_value());
  const std::string devices = run((*link)->client_side(), "cat /proc/net/dev");
  CHECK(devices.find("rs0:") != std::string::npos);
  CHECK(run(*here, "cat /proc/net/dev").find("rs0:") == std::string::npos);
}
