#include <sys/time.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"
#include "server/web/web_frame.hpp"
#include "tests/integration/server/web/fake_server.hpp"
#include "tests/integration/server/web/web_bench.hpp"
#include "tests/support/codec/sample_frame.hpp"
#include "tests/support/core/text_contains.hpp"

namespace runstone::test {
namespace {

// More bytes than the kernel's buffers between the two ends can hold.
constexpr std::size_t kOnTheWayMax = 16 * 1024 * 1024;

/// A browser that is connected through a gateway to a server which the test plays.
struct LinkedBench {
  LinkedBench() {
    REQUIRE(browser.upgrade().status == 101);
    server.accept();
  }

  const TempFolder folder;
  FakeServer server{folder / "web.sock"};
  const std::unique_ptr<WebGateway> gateway = start_gateway(web_config_of(folder));
  WebPeer browser{gateway->port()};
};

TEST_CASE("frames pass unchanged in both directions, however they are cut on the way",
          "[integration]") {
  const TempFolder folder;
  FakeServer server(folder / "web.sock");
  const auto gateway = start_gateway(web_config_of(folder));
  WebPeer browser(gateway->port(), 0x7f000009);
  REQUIRE(browser.upgrade().status == 101);
  CHECK(server.accept().address == peer_endpoint_v4(0x7f000009, 0).address);
  Bytes stream;
  for (const std::size_t body : {std::size_t{1}, kFragmentBytesMax, std::size_t{300}}) {
    const Bytes frame = frame_of(body, static_cast<std::uint8_t>(body));
    browser.send_frame(WebMessage::binary, ByteView(frame).first(5), false);
    browser.send_frame(0, ByteView(frame).subspan(5));
    CHECK(server.read(frame.size()) == frame);
    stream.insert(stream.end(), frame.begin(), frame.end());
  }
  for (const std::uint8_t byte : ByteView(stream).first(20)) server.write({&byte, 1});
  server.write(ByteView(stream).subspan(20));
  // A message has one frame or several, and no part of one.
  Bytes got;
  while (got.size() < stream.size()) {
    const auto message = browser.next();
    REQUIRE(message.has_value());
    CHECK(message->kind == WebMessage::binary);
    got.insert(got.end(), message->bytes.begin(), message->bytes.end());
    const std::size_t first = frame_of(1, 1).size(), second = frame_of(kFragmentBytesMax, 0).size();
    CHECK((got.size() == first || got.size() == first + second || got.size() == stream.size()));
  }
  CHECK(got == stream);
}

TEST_CASE("the gateway reads no more of the server than a browser takes, and ends a silent reader",
          "[integration]") {
  const TempFolder folder;
  FakeServer server(folder / "web.sock");
  WebConfig config = web_config_of(folder);
  config.idle_s = 12;
  const auto gateway = start_gateway(config);
  WebPeer browser(gateway->port());
  REQUIRE(browser.upgrade().status == 101);
  server.accept();
  CHECK(server.write_until_full(frame_of(kFragmentBytesMax, 7), 4 * kOnTheWayMax) < kOnTheWayMax);
  // The other direction still passes, so the browser is not idle. It is ended all the same.
  const Bytes small = frame_of(10, 9);
  browser.send_frame(WebMessage::binary, small);
  CHECK(server.read(small.size()) == small);
  bool is_ended = false;
  for (int i = 0; i < 600 && !is_ended; ++i) {
    browser.send_frame(WebMessage::binary, small);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    is_ended = server.drops_until_closed();
  }
  CHECK(is_ended);
}

TEST_CASE_METHOD(LinkedBench, "the gateway reads no more of a browser than the server takes",
                 "[integration]") {
  const timeval deadline{1, 0};
  ::setsockopt(browser.native_handle(), SOL_SOCKET, SO_SNDTIMEO, &deadline, sizeof deadline);
  const Bytes frame = frame_of(kFragmentBytesMax, 7);
  std::size_t sent = 0;
  while (browser.is_open() && sent < 4 * kOnTheWayMax) {
    browser.send_frame(WebMessage::binary, frame);
    sent += frame.size();
  }
  CHECK(sent < kOnTheWayMax);
  CHECK(server.read(frame.size()) == frame);
}

TEST_CASE("a browser for which the server has no place in its queue is closed with words",
          "[integration]") {
  const TempFolder folder;
  FakeServer server(folder / "web.sock");  // it accepts no connection
  const auto gateway = start_gateway(web_config_of(folder));
  std::vector<std::unique_ptr<WebPeer>> waiting;
  for (int i = 0; i <= FakeServer::kQueueMax; ++i) {
    waiting.push_back(std::make_unique<WebPeer>(gateway->port()));
    REQUIRE(waiting.back()->upgrade().status == 101);
  }
  WebPeer late(gateway->port());
  REQUIRE(late.upgrade().status == 101);
  const auto closed = late.next_close();
  REQUIRE(closed.has_value());
  CHECK(closed->close_code() == 1013);
  CHECK(closed->close_words() == "many players join this world now: try again soon");
  server.accept();
  WebPeer next(gateway->port());
  REQUIRE(next.upgrade().status == 101);
  CHECK_FALSE(next.next(200).has_value());  // it waits for the server
  CHECK(next.is_open());
}

TEST_CASE_METHOD(LinkedBench, "frames of the server that come together are one message",
                 "[integration]") {
  constexpr int kFrames = 40;
  Bytes together;
  for (int i = 0; i < kFrames; ++i) {
    const Bytes frame = frame_of(100, static_cast<std::uint8_t>(i));
    together.insert(together.end(), frame.begin(), frame.end());
  }
  const Bytes last = frame_of(100, 200);
  Bytes sent = together;
  sent.insert(sent.end(), last.begin(), last.begin() + 50);  // a part of a frame waits for the rest
  server.write(sent);
  const auto first = browser.next();
  REQUIRE(first.has_value());
  CHECK(first->bytes == together);
  server.write(ByteView(last).subspan(50));
  const auto second = browser.next();
  REQUIRE(second.has_value());
  CHECK(second->bytes == last);
  WebPeer page(gateway->port());
  const std::string metrics = page.get("/metrics").body;
  CHECK(contains(metrics, "\nrunstone_web_frames_out " + std::to_string(kFrames + 1) + "\n"));
}

TEST_CASE("a server that sends something else than frames ends the WebSocket, not the gateway",
          "[integration]") {
  const TempFolder folder;
  FakeServer server(folder / "web.sock");
  const auto gateway = start_gateway(web_config_of(folder));
  const auto close_after = [&](const Bytes& bytes) {
    WebPeer browser(gateway->port());
    REQUIRE(browser.upgrade().status == 101);
    server.accept();
    server.write(bytes);
    server.hang_up();
    const auto closed = browser.next_close();
    REQUIRE(closed.has_value());
    return closed->close_code();
  };
  CHECK(close_after(Bytes(100)) == 1011);
  Bytes cut = frame_of(100, 7);
  cut.pop_back();
  CHECK(close_after(cut) == 1011);
  // A server that was killed says no goodbye.
  CHECK(close_after(frame_of(100, 7)) == 1012);
  Bytes goodbye = frame_of(100, 7);
  goodbye[2] = wire_number(kKindOf<Goodbye>);
  CHECK(close_after(goodbye) == 1000);
  WebPeer page(gateway->port());
  CHECK(page.get("/style.css").status == 200);
}

}  // namespace
}  // namespace runstone::test
