#include <catch2/catch.hpp>

#include <optional>
#include <string>
#include <vector>

#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/core/hex.hpp"

namespace runstone::test {
namespace {

const FrameReader::OnMessage kIgnore = [](MessageKind, ByteView) -> Result<void> { return {}; };

/// Feeds the stream in pieces of this size. Returns the error, or nullopt if it is accepted.
std::optional<Error> error_in_pieces(ByteView stream, std::size_t piece, Sender sender) {
  FrameReader reader(sender);
  while (!stream.empty()) {
    const ByteView next = stream.first(std::min(piece, stream.size()));
    if (const auto fed = reader.feed(next, kIgnore); !fed) return fed.error();
    stream = stream.subspan(next.size());
  }
  return std::nullopt;
}

/// Returns the error of a server's stream given in hex, or nullopt if it is accepted. The stream
/// has the same result whole and byte by byte.
std::optional<Error> frame_error(std::string_view hex, Sender sender = Sender::server) {
  const Bytes stream = from_hex(hex);
  const auto whole = error_in_pieces(stream, stream.size(), sender);
  CHECK(error_in_pieces(stream, 1, sender) == whole);
  return whole;
}

Bytes frames_of(MessageKind kind, std::size_t size) {
  Bytes stream;
  FrameWriter writer;
  writer.append({kind, std::make_shared<const Bytes>(size, std::uint8_t{7})}, stream);
  return stream;
}

/// Returns a kind of this class that the sender may send, or nullopt.
std::optional<MessageKind> kind_in(FrameClass frame_class, Sender sender) {
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (info_of(kind).frame_class == frame_class && may_send(info_of(kind), sender)) return kind;
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("a frame with a bad header is refused, and the error names where it began",
          "[protocol]") {
  const std::string good = "0100 11 00 00000000 aa";  // Pong
  REQUIRE_FALSE(frame_error(good));
  REQUIRE_FALSE(frame_error(good + "0100 11 00 01000000"));
  const struct {
    const char* second;
    ErrorCode code;
  } cases[] = {
      {"0000 11 00 01000000", ErrorCode::limit_exceeded},  // empty
      {"0140 11 00 01000000", ErrorCode::limit_exceeded},  // 16,385 bytes
      {"ffff 11 00 01000000", ErrorCode::limit_exceeded},
      {"0100 00 00 01000000", ErrorCode::unknown_kind},
      {"0100 1e 00 01000000", ErrorCode::unknown_kind},  // one more than there are
      {"0100 ff 00 01000000", ErrorCode::unknown_kind},
      {"0100 10 00 01000000", ErrorCode::unknown_kind},  // Ping: servers do not send it
      {"0100 11 02 01000000", ErrorCode::bad_value},     // flags
      {"0100 11 81 01000000", ErrorCode::bad_value},
      {"0100 11 00 00000000", ErrorCode::broken_invariant},  // counter: repeated
      {"0100 11 00 02000000", ErrorCode::broken_invariant},  // counter: a frame is missing
      {"0100 11 00 01000001", ErrorCode::broken_invariant},
  };
  for (const auto& c : cases) {
    CAPTURE(c.second);
    const auto error = frame_error(good + c.second);
    REQUIRE(error);
    CHECK(error->code == c.code);
    CHECK(error->offset == 9);
  }
}

TEST_CASE("each side may send its kinds of messages only", "[protocol]") {
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    CAPTURE(info_of(kind).name);
    const Bytes stream = frames_of(kind, 1);
    for (const Sender sender : {Sender::client, Sender::server}) {
      const auto error = error_in_pieces(stream, 100, sender);
      CHECK(error.has_value() != may_send(info_of(kind), sender));
      if (error) CHECK(error->code == ErrorCode::unknown_kind);
    }
  }
}

TEST_CASE("no kind of a client belongs to the class chunks", "[protocol]") {
  CHECK(message_bytes_max(Sender::client, FrameClass::chunks) == 0);
  CHECK_FALSE(kind_in(FrameClass::chunks, Sender::client));
}

TEST_CASE("a frame that interrupts a message of its class is refused", "[protocol]") {
  const std::string begun = "0100 09 01 00000000 aa";  // Commit, more follows
  // Durable is of the same class.
  const auto error = frame_error(begun + "0100 0b 00 01000000 bb");
  REQUIRE(error);
  CHECK(error->code == ErrorCode::broken_invariant);
  CHECK(error->offset == 9);
  // Pong and Chunks are of other classes, and a fragment of the same kind continues the message.
  const std::string between = begun + "0100 11 00 01000000 bb" + "0100 07 01 02000000 cc";
  REQUIRE_FALSE(frame_error(between));
  const std::string ended = between + "0100 09 00 03000000 dd";
  REQUIRE_FALSE(frame_error(ended));
  REQUIRE_FALSE(frame_error(ended + "0100 0b 00 04000000 bb"));
  // The message of the class chunks has not ended.
  CHECK(frame_error(ended + "0100 19 00 04000000 bb"));
}

TEST_CASE("a message may have the size of its class limit and not one byte more", "[protocol]") {
  for (const Sender sender : {Sender::client, Sender::server}) {
    for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
      const auto kind = kind_in(c, sender);
      if (!kind) continue;
      const std::size_t limit = message_bytes_max(sender, c);
      std::size_t got = 0;
      FrameReader reader(sender);
      const auto fed = reader.feed(frames_of(*kind, limit),
                                   [&](MessageKind got_kind, ByteView body) -> Result<void> {
                                     CHECK(got_kind == *kind);
                                     got = body.size();
                                     return {};
                                   });
      REQUIRE(fed.has_value());
      CHECK(got == limit);
      const auto error = error_in_pieces(frames_of(*kind, limit + 1), 1 << 20, sender);
      REQUIRE(error);
      CHECK(error->code == ErrorCode::limit_exceeded);
    }
  }
}

TEST_CASE("after an error the reader returns it for every call", "[protocol]") {
  FrameReader reader(Sender::server);
  const auto first = reader.feed(from_hex("0100 11 00 05000000"), kIgnore);
  REQUIRE_FALSE(first.has_value());
  bool called = false;
  const auto second =
      reader.feed(frames_of(kKindOf<Pong>, 1), [&](MessageKind, ByteView) -> Result<void> {
        called = true;
        return {};
      });
  REQUIRE_FALSE(second.has_value());
  CHECK(second.error() == first.error());
  CHECK_FALSE(called);
}

TEST_CASE("an error of the handler ends the stream with that error", "[protocol]") {
  Bytes stream = frames_of(kKindOf<Commit>, 3);
  FrameReader reader(Sender::server);
  int calls = 0;
  const auto refuse = [&calls](MessageKind, ByteView) -> Result<void> {
    ++calls;
    return fail(ErrorCode::unknown_kind, "not for me", 77);
  };
  const auto fed = reader.feed(stream, refuse);
  REQUIRE_FALSE(fed.has_value());
  CHECK(fed.error().offset == 77);
  CHECK_FALSE(reader.feed(stream, refuse).has_value());
  CHECK(calls == 1);
}

TEST_CASE("large messages are cut into fragments of 16 KiB, and only the last lacks the flag",
          "[protocol]") {
  const Bytes stream = frames_of(kKindOf<Chunks>, 2 * kFragmentBytesMax + 1);
  REQUIRE(stream.size() == 2 * kFragmentBytesMax + 1 + 3 * kFrameHeaderBytes);
  const std::size_t second = kFragmentBytesMax + kFrameHeaderBytes;
  for (const std::size_t at : {std::size_t{0}, second, 2 * second}) {
    CHECK(stream[at + 2] == wire_number(kKindOf<Chunks>));
    CHECK(stream[at + 3] == (at == 2 * second ? 0 : 1));
    CHECK(stream[at + 4] == at / second);
  }
  CHECK(stream[2 * second] == 1);  // length
}

TEST_CASE("a reader counts the frames and their bytes by class", "[protocol]") {
  FrameReader reader(Sender::server);
  // A whole Pong, the first half of a Chunks message, and the header of its second half.
  const Bytes stream = from_hex(
      "0100 11 00 00000000 aa"
      "0200 07 01 01000000 bbbb"
      "0300 07 00 02000000 cc");
  REQUIRE(reader.feed(stream, kIgnore).has_value());
  CHECK(reader.frames(FrameClass::control) == 1);
  CHECK(reader.frame_bytes(FrameClass::control) == 9);
  CHECK(reader.frames(FrameClass::chunks) == 2);
  CHECK(reader.frame_bytes(FrameClass::chunks) == 19);
  CHECK(reader.frames(FrameClass::edits) == 0);
  CHECK(reader.frame_bytes(FrameClass::edits) == 0);
}

TEST_CASE("a reader bounds the bytes of messages that the next bytes complete", "[protocol]") {
  constexpr std::size_t kSize = 40'000, kPiece = 1'000;
  const Bytes stream = frames_of(kKindOf<EditRequest>, kSize);
  FrameReader reader(Sender::client);
  std::size_t completed = 0, bounds_above = 0;
  const FrameReader::OnMessage on_message = [&](MessageKind, ByteView body) -> Result<void> {
    completed += body.size();
    return {};
  };
  for (ByteView left = stream; !left.empty();) {
    const ByteView next = left.first(std::min(kPiece, left.size()));
    const std::size_t bound = reader.completed_bytes_max(next.size());
    const std::size_t before = completed;
    REQUIRE(reader.feed(next, on_message));
    CHECK(completed - before <= bound);
    if (bound > 2 * kPiece) ++bounds_above;
    left = left.subspan(next.size());
  }
  CHECK(completed == kSize);
  CHECK(bounds_above <= 3);  // the ends of the three frames
}

TEST_CASE("an empty piece of a stream is accepted", "[protocol]") {
  FrameReader reader(Sender::client);
  CHECK(reader.feed({}, kIgnore).has_value());
  CHECK(reader.feed(frames_of(kKindOf<Ping>, 5), kIgnore).has_value());
}

}  // namespace runstone::test
