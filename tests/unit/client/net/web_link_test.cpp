// A link over a WebSocket, to a gateway that each test controls by hand.
#include <openssl/evp.h>
#include <openssl/sha.h>

#include <array>
#include <asio.hpp>
#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "client/net/net_client.hpp"
#include "protocol/codec/frame.hpp"
#include "tests/unit/client/net/next_event.hpp"

using namespace runstone;
using asio::ip::tcp;

namespace {

class FakeGateway {
 public:
  FakeGateway()
      : acceptor_(io_, tcp::endpoint(asio::ip::address_v4::loopback(), 0)), socket_(io_) {}
  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  /// Waits for a request and returns the answer that opens the WebSocket.
  Bytes accept() {
    socket_ = acceptor_.accept();
    std::string request;
    const std::size_t end = asio::read_until(socket_, asio::dynamic_buffer(request), "\r\n\r\n");
    REQUIRE(end == request.size());
    const std::string name = "\r\nSec-WebSocket-Key: ";
    const std::size_t at = request.find(name);
    REQUIRE(at != std::string::npos);
    const std::size_t begin = at + name.size();
    const std::string text = request.substr(begin, request.find("\r\n", begin) - begin) +
                             "258EAFA5-E914-47DA-95CA-C5AB0DC85B11";
    std::array<unsigned char, SHA_DIGEST_LENGTH> digest{};
    SHA1(reinterpret_cast<const unsigned char*>(text.data()), text.size(), digest.data());
    std::array<unsigned char, 4 * ((SHA_DIGEST_LENGTH + 2) / 3) + 1> base64{};
    EVP_EncodeBlock(base64.data(), digest.data(), static_cast<int>(digest.size()));
    const std::string answer =
        "HTTP/1.1 101 Switching Protocols\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Accept: " +
        std::string(reinterpret_cast<const char*>(base64.data())) + "\r\n\r\n";
    return {answer.begin(), answer.end()};
  }
  /// Sends all of it in one piece.
  void send(const Bytes& bytes) { asio::write(socket_, asio::buffer(bytes)); }

 private:
  asio::io_context io_;
  tcp::acceptor acceptor_;
  tcp::socket socket_;
};

/// Returns a WebSocket frame of a gateway.
Bytes web_frame(std::uint8_t first, const Bytes& contents) {
  REQUIRE(contents.size() < 126);
  Bytes out{first, static_cast<std::uint8_t>(contents.size())};
  out.insert(out.end(), contents.begin(), contents.end());
  return out;
}

/// Returns a pong of the server, in a WebSocket frame.
Bytes pong_frame(FrameWriter& writer, TimeUs sent_us) {
  Bytes out;
  writer.append(encode_message(Pong{sent_us, 1}), out);
  return web_frame(0x82, out);
}

Bytes close_frame() { return web_frame(0x88, {0x03, 0xe8, 'b', 'y', 'e'}); }

Bytes joined(std::initializer_list<Bytes> parts) {
  Bytes out;
  for (const Bytes& part : parts) out.insert(out.end(), part.begin(), part.end());
  return out;
}

struct WebLinkFixture {
  WebLinkFixture() {
    LinkConfig config;
    config.tls.reset();
    config.host = "127.0.0.1";
    config.port = gateway.port();
    config.web_path = "/play";
    config.pause_ms_first = 1;
    config.pause_ms_max = 10;
    client.emplace(std::move(config), [this] { wake.notify(); });
  }
  /// Returns the next event of this kind. Fails the test if another one comes, or none.
  template <class Event>
  Event next() {
    LinkEvent event = test::next_event(*client, wake, events);
    REQUIRE(std::holds_alternative<Event>(event));
    return std::get<Event>(std::move(event));
  }
  void sees_pong_and_end(TimeUs sent_us) {
    CHECK(std::get<Pong>(next<LinkReceived>().message).sent_us == sent_us);
    CHECK(next<LinkDisconnected>().why == "the gateway closed the WebSocket: bye");
  }
  FakeGateway gateway;
  WakeUp wake;
  std::vector<LinkEvent> events;
  std::optional<NetClient> client;
};

}  // namespace

TEST_CASE_METHOD(WebLinkFixture, "a message that comes with the close frame in one piece is read",
                 "[client_net]") {
  gateway.send(gateway.accept());
  next<LinkConnected>();
  FrameWriter writer;
  const Bytes first = pong_frame(writer, 7), second = pong_frame(writer, 8);
  gateway.send(joined({first, second, close_frame()}));
  CHECK(std::get<Pong>(next<LinkReceived>().message).sent_us == 7);
  sees_pong_and_end(8);
}

TEST_CASE_METHOD(WebLinkFixture, "a message and the close frame that come with the answer are read",
                 "[client_net]") {
  const Bytes answer = gateway.accept();
  FrameWriter writer;
  gateway.send(joined({answer, pong_frame(writer, 7), close_frame()}));
  next<LinkConnected>();
  sees_pong_and_end(7);
}

TEST_CASE_METHOD(WebLinkFixture, "after a close frame the link connects again and reads again",
                 "[client_net]") {
  for (const TimeUs sent_us : {1, 2, 3}) {
    CAPTURE(sent_us);
    gateway.send(gateway.accept());
    next<LinkConnected>();
    FrameWriter writer;
    gateway.send(pong_frame(writer, sent_us));
    CHECK(std::get<Pong>(next<LinkReceived>().message).sent_us == sent_us);
    gateway.send(close_frame());
    CHECK(next<LinkDisconnected>().why == "the gateway closed the WebSocket: bye");
  }
}
