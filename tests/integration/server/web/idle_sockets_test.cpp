// 2,000 sockets that do nothing, in several states and of many addresses.
#include <arpa/inet.h>

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "common/os/open_files.hpp"
#include "common/os/process_memory.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/net/web_player.hpp"
#include "tests/support/tls/pem_files.hpp"

namespace runstone::test {
namespace {

constexpr std::size_t kIdle = 2'000;
constexpr std::size_t kPerAddress = 50;
#ifndef RUNSTONE_SANITIZED
constexpr std::uint64_t kIdleBytesMax = 200'000'000;
#endif
constexpr std::uint32_t kFirstAddress = 0x7f010001;  // 127.1.0.1

/// The first bytes of a TLS handshake: the header of a record and a part of a ClientHello.
const std::string kHalfHello("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11);

std::uint32_t address_of(std::size_t i) {
  return kFirstAddress + static_cast<std::uint32_t>(i / kPerAddress);
}

/// Makes a socket of the state that its number gives: only connected, within the TLS handshake,
/// within a request, or a WebSocket that is silent.
std::unique_ptr<WebPeer> make_idle(std::uint16_t port, std::size_t i) {
  const bool is_secure = i % 4 >= 2;
  auto peer = std::make_unique<WebPeer>(port, address_of(i), is_secure);
  if (i % 4 == 1) peer->send(kHalfHello);
  if (i % 4 == 2) peer->send("GET / HTTP/1.1\r\nHost: half of a requ");
  if (i % 4 == 3 && peer->is_open()) peer->upgrade();
  return peer;
}

/// Makes all of them. Every state comes from every address. Most of the time passes until threads
/// wake up, so several make them at once.
std::vector<std::unique_ptr<WebPeer>> make_all_idle(std::uint16_t port) {
  constexpr std::size_t kThreads = 16;
  std::vector<std::unique_ptr<WebPeer>> out(kIdle);
  std::vector<std::thread> threads;
  for (std::size_t first = 0; first < kThreads; ++first) {
    threads.emplace_back([&out, port, first] {
      for (std::size_t i = first; i < kIdle; i += kThreads) out[i] = make_idle(port, i);
    });
  }
  for (std::thread& thread : threads) thread.join();
  return out;
}

std::uint64_t metric(std::uint16_t port, const std::string& name) {
  WebPeer peer(port, INADDR_LOOPBACK, true);
  const std::string body = peer.get("/metrics").body, wanted = "\nrunstone_web_" + name + " ";
  const std::size_t at = body.find(wanted);
  REQUIRE(at != std::string::npos);
  return std::stoull(body.substr(at + wanted.size()));
}

bool answers(WebPlayer& player) {
  player.send(Ping{5});
  return player.next_of<Pong>().has_value();
}

TEST_CASE("2,000 idle sockets disturb neither a player nor one who joins", "[integration]") {
  REQUIRE(allow_open_files(3 * kIdle) >= 3 * kIdle);
  const TempFolder folder;
  const PemFiles pem("localhost");
  WebConfig config = web_config_of(folder);
  config.tls_certificate = pem.chain_file();
  config.tls_key = pem.key_file();
  config.handshake_s = 3'600;  // no socket ends because of its age
  config.sockets_max = 1'000;
  config.sockets_per_address = 64;
  const WebBench bench(server_config_of(folder), config);
  WebPlayer player(bench.port(), INADDR_LOOPBACK, true);
  REQUIRE(player.join(1).has_value());
#ifndef RUNSTONE_SANITIZED
  const std::uint64_t before = process_memory_bytes();
#endif
  const auto idle = make_all_idle(bench.port());
  CHECK(answers(player));
  WebPlayer newcomer(bench.port(), INADDR_LOOPBACK, true);
  REQUIRE(newcomer.is_open());
  CHECK(newcomer.join(2).has_value());
  CHECK(answers(newcomer));
  CHECK(answers(player));
  // The sockets of the test and of the server are in this process, too. AddressSanitizer keeps freed
  // memory for a while, so with it the memory says nothing.
#ifndef RUNSTONE_SANITIZED
  const std::uint64_t now = process_memory_bytes();
  CHECK(now < before + kIdleBytesMax);
#endif
  CHECK(metric(bench.port(), "connections_open") <= config.sockets_max);
  // There are more sockets than the gateway holds.
  CHECK(metric(bench.port(), "evicted") > 0);
}

TEST_CASE("when all sockets are silent WebSockets, the oldest of them makes room",
          "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.sockets_max = 4;
  const WebBench bench(server_config_of(folder), config);
  WebPlayer player(bench.port());
  REQUIRE(player.join(1).has_value());
  std::vector<std::unique_ptr<WebPeer>> silent;
  for (int i = 0; i < 3; ++i) {
    silent.push_back(std::make_unique<WebPeer>(bench.port()));
    REQUIRE(silent.back()->upgrade().status == 101);
  }
  WebPlayer newcomer(bench.port());
  REQUIRE(newcomer.is_open());
  CHECK(newcomer.join(2).has_value());
  CHECK(silent.front()->sees_the_end());
  CHECK(answers(player));
  CHECK(answers(newcomer));
}

}  // namespace
}  // namespace runstone::test
