#include "client/net/web_socket.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "protocol/codec/frame.hpp"
#include "tests/support/codec/sample_frame.hpp"

using namespace runstone;
using runstone::test::frame_of;

namespace {

/// Returns a frame of a gateway, with these first two bytes.
Bytes from_gateway(std::uint8_t first, std::uint8_t second, const std::string& contents = "") {
  Bytes out{first, second};
  out.insert(out.end(), contents.begin(), contents.end());
  return out;
}

/// Takes the mask off a message of a client of less than 126 bytes, and removes the message.
Bytes take_message(Bytes& sent, int kind) {
  REQUIRE(sent.size() >= 6);
  CHECK(sent[0] == (0x80 | kind));
  REQUIRE((sent[1] & 0x80) != 0);
  const std::size_t bytes = sent[1] & 0x7f;
  REQUIRE(sent.size() >= 6 + bytes);
  Bytes out;
  for (std::size_t i = 0; i < bytes; ++i) out.push_back(sent[6 + i] ^ sent[2 + i % 4]);
  sent.erase(sent.begin(), sent.begin() + static_cast<std::ptrdiff_t>(6 + bytes));
  return out;
}

}  // namespace

TEST_CASE("each frame of the protocol is a masked message of its own", "[client_net]") {
  WebSocketCodec codec;
  FrameWriter writer;
  const Bytes one = frame_of(writer, 5), two = frame_of(writer, 90);
  Bytes frames = one, sent;
  frames.insert(frames.end(), two.begin(), two.end());
  codec.write(frames, sent);
  CHECK(take_message(sent, 2) == one);
  CHECK(take_message(sent, 2) == two);
  CHECK(sent.empty());
  codec.write(frame_of(writer, kFragmentBytesMax), sent);
  CHECK(sent[1] == (0x80 | 126));
  CHECK(sent.size() == 8 + kFrameHeaderBytes + kFragmentBytesMax);
}

TEST_CASE("messages of a gateway are read however they are cut", "[client_net]") {
  Bytes stream = from_gateway(0x82, 3, "abc");
  for (const Bytes& more :
       {from_gateway(0x02, 2, "de"), from_gateway(0x89, 1, "p"), from_gateway(0x80, 1, "f"),
        from_gateway(0x82, 126, std::string("\0\x7e", 2) + std::string(126, 'g'))})
    stream.insert(stream.end(), more.begin(), more.end());
  const std::string expected = "abcdef" + std::string(126, 'g');
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    CAPTURE(piece);
    WebSocketCodec codec;
    Bytes out;
    for (ByteView left(stream); !left.empty();) {
      const ByteView next = left.first(std::min(piece, left.size()));
      left = left.subspan(next.size());
      REQUIRE(codec.read(next, out).has_value());
    }
    CHECK(std::string(out.begin(), out.end()) == expected);
    // The answer to the ping comes before the next message.
    FrameWriter writer;
    const Bytes frame = frame_of(writer, 5);
    Bytes sent;
    codec.write(frame, sent);
    CHECK(take_message(sent, 10) == Bytes{'p'});
    CHECK(take_message(sent, 2) == frame);
  }
}

TEST_CASE("what breaks a rule of WebSockets is refused in words", "[client_net]") {
  const auto error_of = [](const Bytes& bytes) {
    WebSocketCodec codec;
    Bytes out;
    const auto read = codec.read(bytes, out);
    return read ? std::string() : read.error();
  };
  CHECK(error_of(from_gateway(0x82, 0x83)).find("masked") != std::string::npos);
  CHECK(error_of(from_gateway(0x81, 1, "a")).find("binary") != std::string::npos);
  CHECK(error_of(from_gateway(0x80, 1, "a")).find("binary") != std::string::npos);
  CHECK(error_of(from_gateway(0x09, 1, "a")).find("control") != std::string::npos);
  CHECK(error_of(from_gateway(0x89, 126, std::string("\0\x7e", 2))).find("control") !=
        std::string::npos);
  CHECK(error_of(from_gateway(0x88, 6, std::string("\x03\xe9", 2) + "stop")) ==
        "the gateway closed the WebSocket: stop");
  CHECK(error_of(from_gateway(0x88, 0)) == "the gateway closed the WebSocket");
}

TEST_CASE("an answer that opens no WebSocket is refused with the words of the gateway",
          "[client_net]") {
  const WebSocketCodec codec;
  CHECK(
      codec.request("localhost:8080", "/play").find("GET /play HTTP/1.1\r\nHost: localhost:8080") ==
      0);
  CHECK(codec.read_answer("HTTP/1.1 101 Switch").value() == 0);
  const auto refused =
      codec.read_answer("HTTP/1.1 404 Not Found\r\nX: y\r\n\r\nthere is no WebSocket\n");
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error() ==
        "the gateway opens no WebSocket: HTTP/1.1 404 Not Found: there is no WebSocket");
  CHECK_FALSE(codec
                  .read_answer("HTTP/1.1 101 Switching Protocols\r\nSec-WebSocket-Accept: "
                               "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=\r\n\r\n")
                  .has_value());
  CHECK_FALSE(codec.read_answer(std::string(WebSocketCodec::kAnswerBytesMax, 'a')).has_value());
}
