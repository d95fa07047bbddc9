// WebPlayer: a player behind a gateway: messages of the protocol over a WebSocket.
#pragma once
#include <algorithm>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/messages.hpp"
#include "tests/support/net/web_peer.hpp"

namespace runstone::test {

class WebPlayer {
 public:
  /// Connects and opens the WebSocket.
  explicit WebPlayer(std::uint16_t port, std::uint32_t from = INADDR_LOOPBACK,
                     bool is_encrypted = false, const std::string& path = "/play")
      : peer(port, from, is_encrypted) {
    is_open_ = peer.upgrade(path).status == 101;
  }
  bool is_open() const { return is_open_; }

  void send(const Message& message) {
    const EncodedMessage encoded = encode_message(message);
    ByteView left(*encoded.bytes);
    while (!left.empty()) {
      const ByteView body = left.first(std::min(left.size(), kFragmentBytesMax));
      left = left.subspan(body.size());
      const FrameHeader header = frames_.next(encoded.kind, body.size(), !left.empty());
      Bytes frame(header.begin(), header.end());
      frame.insert(frame.end(), body.begin(), body.end());
      peer.send_frame(WebMessage::binary, frame);
    }
  }
  /// Returns the next message, or nullopt if the WebSocket ends or the deadline passes. `closed` is
  /// then the close frame, if there was one.
  std::optional<Message> next() { return next_within(10'000); }
  std::optional<Message> next_within(int deadline_ms) {
    while (arrived_.empty()) {
      auto got = peer.next(deadline_ms);
      if (!got) return std::nullopt;
      if (got->kind == WebMessage::close) {
        closed = *std::move(got);
        return std::nullopt;
      }
      RUNSTONE_ASSERT(got->kind == WebMessage::binary);
      const std::uint64_t before = frames_read();
      const auto fed = reader_.feed(
          got->bytes, [this](MessageKind kind, ByteView body) { return decode(kind, body); });
      RUNSTONE_ASSERT(fed.has_value() && frames_read() > before);  // whole frames
    }
    Message message = std::move(arrived_.front());
    arrived_.pop_front();
    return message;
  }
  template <class Kind>
  std::optional<Kind> next_of() {
    while (auto message = next()) {
      if (auto* found = std::get_if<Kind>(&*message)) return std::move(*found);
      if (auto* goodbye = std::get_if<Goodbye>(&*message)) refusal = goodbye->text;
    }
    return std::nullopt;
  }
  /// Sends a ping. Returns true if the server answers it.
  bool gets_pong() {
    send(Ping{5});
    return next_of<Pong>().has_value();
  }
  /// Does the whole handshake. Returns nullopt if the server refused; `refusal` then has its words.
  std::optional<SessionAccepted> join(std::uint8_t who) {
    KeySeed seed{};
    seed.fill(who);
    const KeyPair keys = key_pair_of(seed);
    Hello hello;
    hello.key = keys.public_key;
    hello.instance = 1;
    hello.encodings = 1;  // raw: the largest
    hello.name = "player" + std::to_string(who);
    send(hello);
    const auto welcome = next_of<Welcome>();
    if (!welcome) return std::nullopt;
    // A browser does not know its TLS connection, so nothing is bound to it.
    if (!verify(welcome->server_key, server_transcript(hello, *welcome, std::nullopt),
                welcome->signature))
      return std::nullopt;
    send(ClientAuth{sign(keys, client_transcript(hello, *welcome, std::nullopt)), {}});
    return next_of<SessionAccepted>();
  }

  std::uint64_t frames_read() const {
    return reader_.frames(FrameClass::control) + reader_.frames(FrameClass::edits) +
           reader_.frames(FrameClass::chunks);
  }
  std::uint64_t messages_read() const { return messages_; }

  WebPeer peer;
  std::string refusal;
  std::optional<WebMessage> closed;

 private:
  Result<void> decode(MessageKind kind, ByteView body) {
    auto message = decode_message(Sender::server, kind, body, chunk_edge_);
    if (!message) return failure(message.error());
    if (const auto* welcome = std::get_if<Welcome>(&*message)) chunk_edge_ = welcome->chunk_edge;
    arrived_.push_back(*std::move(message));
    ++messages_;
    return {};
  }

  bool is_open_ = false;
  std::uint64_t messages_ = 0;
  std::uint16_t chunk_edge_ = 0;
  FrameWriter frames_;
  FrameReader reader_{Sender::server};
  std::deque<Message> arrived_;
};

}  // namespace runstone::test
