#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <vector>

#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/codec/sample_frame.hpp"
#include "tests/support/net/web_player.hpp"

namespace runstone::test {
namespace {

TEST_CASE("a message that is not one frame closes the WebSocket with a code and words",
          "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPlayer bystander(bench.port());
  REQUIRE(bystander.join(1).has_value());
  struct Case {
    int kind;
    Bytes bytes;
    int code;
    std::string words;
  };
  Bytes two = frame_of(20);
  const Bytes second = frame_of(30);
  two.insert(two.end(), second.begin(), second.end());
  Bytes cut = frame_of(20);
  cut.pop_back();
  const std::vector<Case> cases = {
      {WebMessage::text, frame_of(20), 1003, "only binary messages are read here"},
      {WebMessage::binary, {}, 1007, "a message must be one frame, and this is shorter"},
      {WebMessage::binary, Bytes(8), 1007, "a message must be one frame, and this is shorter"},
      {WebMessage::binary, cut, 1007, "a message must be exactly one frame"},
      {WebMessage::binary, two, 1007, "a message must be exactly one frame"},
      {WebMessage::binary, Bytes(16'393), 1009, "a frame has at most 16392 bytes"},
      {WebMessage::binary, Bytes(2'000'000), 1009, "a frame has at most 16392 bytes"},
  };
  for (const Case& each : cases) {
    CAPTURE(each.words, each.bytes.size());
    WebPeer peer(bench.port());
    REQUIRE(peer.upgrade().status == 101);
    peer.send_frame(each.kind, each.bytes);
    const auto closed = peer.next_close();
    REQUIRE(closed.has_value());
    CHECK(closed->close_code() == each.code);
    CHECK(closed->close_words() == each.words);
    CHECK(peer.sees_the_end());
  }
  bystander.send(Ping{5});
  CHECK(bystander.next_of<Pong>().has_value());
}

TEST_CASE("a message in fragments is read as one, and its size counts as a whole",
          "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPeer peer(bench.port());
  REQUIRE(peer.upgrade().status == 101);
  peer.send_frame(WebMessage::binary, Bytes(10'000), false);
  peer.send_frame(0, Bytes(10'000), false);
  const auto closed = peer.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1009);
}

TEST_CASE("a length without end and a frame without a mask close the WebSocket", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  for (const std::uint64_t length : {1ULL << 25, 1ULL << 62, 1ULL << 63}) {
    CAPTURE(length);
    WebPeer endless(bench.port());
    REQUIRE(endless.upgrade().status == 101);
    Bytes header{0x82};
    WebPeer::append_length(header, length);
    header.insert(header.end(), {1, 2, 3, 4});
    endless.send(header);  // nothing follows
    const auto closed = endless.next_close();
    REQUIRE(closed.has_value());
    CHECK(closed->close_code() == 1009);
  }
  WebPeer unmasked(bench.port());
  REQUIRE(unmasked.upgrade().status == 101);
  unmasked.send(Bytes{0x82, 0x02, 1, 2});
  const auto refused = unmasked.next_close();
  REQUIRE(refused.has_value());
  CHECK(refused->close_code() == 1002);
}

TEST_CASE("a browser that sends pings without end is closed with words", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  WebPlayer bystander(bench.port());
  REQUIRE(bystander.join(1).has_value());
  WebPeer peer(bench.port());
  REQUIRE(peer.upgrade().status == 101);
  for (int i = 0; i < 150; ++i) peer.send_frame(WebMessage::ping, Bytes(100));
  const auto closed = peer.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1008);
  CHECK(closed->close_words() == "a browser sends no pings");
  bystander.send(Ping{5});
  CHECK(bystander.next_of<Pong>().has_value());
}

TEST_CASE("only pages of the gateway may open a WebSocket", "[integration]") {
  const TempFolder folder;
  const WebBench bench(folder);
  const auto status = [&](const std::string& more) {
    WebPeer peer(bench.port());
    return peer.upgrade("/play", more).status;
  };
  CHECK(status("") == 101);
  CHECK(status("Origin: http://127.0.0.1:" + std::to_string(bench.port()) + "\r\n") == 101);
  CHECK(status("Origin: http://evil.example\r\n") == 403);
  CHECK(status("Origin: null\r\n") == 403);
  CHECK(status("Origin: http://127.0.0.1:" + std::to_string(bench.port()) +
               "\r\nOrigin: http://evil.example\r\n") == 403);
  WebPeer elsewhere(bench.port());
  CHECK(elsewhere.upgrade("/status").status == 404);
}

TEST_CASE("idle sockets cost others nothing and are closed", "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.handshake_s = 2;
  const WebBench bench(server_config_of(folder), config);
  WebPlayer player(bench.port());
  REQUIRE(player.join(1).has_value());
  std::vector<std::unique_ptr<WebPeer>> idle;
  for (int i = 0; i < 200; ++i) {
    idle.push_back(std::make_unique<WebPeer>(bench.port()));
    REQUIRE(idle.back()->is_open());
    if (i % 2 == 0) idle.back()->send("GET / HTTP/1.1\r\nHost: half of a requ");
  }
  player.send(Ping{5});
  CHECK(player.next_of<Pong>().has_value());
  for (const auto& each : idle) CHECK(each->sees_the_end());
  player.send(Ping{6});
  CHECK(player.next_of<Pong>().has_value());
}

TEST_CASE("an address has few sockets, and when all are taken the oldest idle one makes room",
          "[integration]") {
  const TempFolder folder;
  WebConfig config = web_config_of(folder);
  config.sockets_per_address = 3;
  config.sockets_max = 5;
  const WebBench bench(server_config_of(folder), config);
  WebPlayer player(bench.port());
  REQUIRE(player.join(1).has_value());
  std::vector<std::unique_ptr<WebPeer>> idle;
  const auto connect = [&](std::uint32_t from) -> WebPeer& {
    idle.push_back(std::make_unique<WebPeer>(bench.port(), from));
    return *idle.back();
  };
  connect(INADDR_LOOPBACK);
  WebPeer& oldest = *idle.front();
  connect(INADDR_LOOPBACK);
  CHECK(connect(INADDR_LOOPBACK).sees_the_end());  // a fourth socket of one address
  connect(0x7f000002);
  connect(0x7f000002);
  WebPeer& last = connect(0x7f000002);
  CHECK(oldest.sees_the_end());
  const std::string metrics = last.get("/metrics").body;
  CHECK(metrics.find("\nrunstone_web_refused 1\n") != std::string::npos);
  CHECK(metrics.find("\nrunstone_web_evicted 1\n") != std::string::npos);
  player.send(Ping{5});
  CHECK(player.next_of<Pong>().has_value());  // a WebSocket is never closed for a new socket
}

}  // namespace
}  // namespace runstone::test
