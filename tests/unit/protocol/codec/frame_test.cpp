#include <catch2/catch.hpp>

#include <optional>
#include <string>

#include "protocol/codec/frame.hpp"
#include "tests/support/hex.hpp"

namespace runstone::test {
namespace {

const FrameReader::OnMessage kIgnore = [](FrameClass, ByteView) -> Result<void> { return {}; };

/// Returns the error of a server's stream given in hex, or nullopt if it is accepted.
std::optional<Error> error_of(std::string_view hex, Sender sender = Sender::server) {
  FrameReader reader(sender);
  const auto fed = reader.feed(from_hex(hex), kIgnore);
  if (fed) return std::nullopt;
  return fed.error();
}

Bytes frames_of(FrameClass frame_class, std::size_t size) {
  Bytes stream;
  FrameWriter writer;
  writer.append({frame_class, std::make_shared<const Bytes>(size, std::uint8_t{7})}, stream);
  return stream;
}

}  // namespace

TEST_CASE("a frame with a bad header is refused, and the error names where it began",
          "[protocol]") {
  const std::string good = "01000000 00 00 0000 00000000 aa";
  REQUIRE_FALSE(error_of(good));
  const struct {
    const char* second;
    ErrorCode code;
  } cases[] = {
      {"00000000 00 00 0000 01000000", ErrorCode::limit_exceeded},  // empty
      {"01400000 00 00 0000 01000000", ErrorCode::limit_exceeded},  // 16,385 bytes
      {"ffffffff 00 00 0000 01000000", ErrorCode::limit_exceeded},
      {"01000000 03 00 0000 01000000", ErrorCode::unknown_kind},  // class
      {"01000000 ff 00 0000 01000000", ErrorCode::unknown_kind},
      {"01000000 00 02 0000 01000000", ErrorCode::bad_value},  // flags
      {"01000000 00 81 0000 01000000", ErrorCode::bad_value},
      {"01000000 00 00 0100 01000000", ErrorCode::bad_value},  // reserved
      {"01000000 00 00 0080 01000000", ErrorCode::bad_value},
      {"01000000 00 00 0000 00000000", ErrorCode::broken_invariant},  // counter: repeated
      {"01000000 00 00 0000 02000000", ErrorCode::broken_invariant},  // counter: a frame is missing
      {"01000000 00 00 0000 01000001", ErrorCode::broken_invariant},
  };
  for (const auto& c : cases) {
    CAPTURE(c.second);
    const auto error = error_of(good + c.second);
    REQUIRE(error);
    CHECK(error->code == c.code);
    CHECK(error->offset == 13);
  }
}

TEST_CASE("servers may use the class chunks, clients may not", "[protocol]") {
  CHECK(message_bytes_max(Sender::client, FrameClass::chunks) == 0);
  const std::string frame = "01000000 02 00 0000 00000000 aa";
  CHECK_FALSE(error_of(frame, Sender::server));
  const auto error = error_of(frame, Sender::client);
  REQUIRE(error);
  CHECK(error->code == ErrorCode::unknown_kind);
}

TEST_CASE("a message may have the size of its class limit and not one byte more", "[protocol]") {
  for (const Sender sender : {Sender::client, Sender::server}) {
    for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
      const std::size_t limit = message_bytes_max(sender, c);
      if (limit == 0) continue;
      std::size_t got = 0;
      FrameReader reader(sender);
      REQUIRE(reader.feed(frames_of(c, limit), [&got](FrameClass, ByteView body) -> Result<void> {
        got = body.size();
        return {};
      }));
      CHECK(got == limit);
      FrameReader strict(sender);
      const auto fed = strict.feed(frames_of(c, limit + 1), kIgnore);
      REQUIRE_FALSE(fed.has_value());
      CHECK(fed.error().code == ErrorCode::limit_exceeded);
    }
  }
}

TEST_CASE("after an error the reader returns it for every call", "[protocol]") {
  FrameReader reader(Sender::server);
  const auto first = reader.feed(from_hex("01000000 00 00 0000 05000000"), kIgnore);
  REQUIRE_FALSE(first.has_value());
  bool called = false;
  const auto second =
      reader.feed(frames_of(FrameClass::control, 1), [&](FrameClass, ByteView) -> Result<void> {
        called = true;
        return {};
      });
  REQUIRE_FALSE(second.has_value());
  CHECK(second.error() == first.error());
  CHECK_FALSE(called);
}

TEST_CASE("an error of the handler ends the stream with that error", "[protocol]") {
  Bytes stream = frames_of(FrameClass::edits, 3);
  FrameReader reader(Sender::server);
  int calls = 0;
  const auto refuse = [&calls](FrameClass, ByteView) -> Result<void> {
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
  const Bytes stream = frames_of(FrameClass::chunks, 2 * kFragmentBytesMax + 1);
  REQUIRE(stream.size() == 2 * kFragmentBytesMax + 1 + 3 * kFrameHeaderBytes);
  const std::size_t second = kFragmentBytesMax + kFrameHeaderBytes;
  CHECK(stream[5] == 1);
  CHECK(stream[second + 5] == 1);
  CHECK(stream[2 * second + 5] == 0);
  CHECK(stream[2 * second] == 1);  // length
}

TEST_CASE("an empty piece of a stream is accepted", "[protocol]") {
  FrameReader reader(Sender::client);
  CHECK(reader.feed({}, kIgnore).has_value());
  CHECK(reader.feed(frames_of(FrameClass::control, 5), kIgnore).has_value());
}

}  // namespace runstone::test
