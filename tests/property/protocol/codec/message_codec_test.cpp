#include <catch2/catch.hpp>

#include "protocol/codec/message_table.hpp"
#include "tests/support/random_message.hpp"

namespace runstone::test {
namespace {

/// Returns true for a Hello or Welcome of another version: it decodes to its version alone.
bool of_other_protocol(const Message& message) {
  if (const auto* hello = std::get_if<Hello>(&message)) return hello->protocol != kProtocolVersion;
  if (const auto* welcome = std::get_if<Welcome>(&message))
    return welcome->protocol != kProtocolVersion;
  return false;
}

/// Decodes altered bytes on both sides and in every class. Each gives an error, or a struct that
/// encodes to bytes which decode to it again.
void survives(const Bytes& bytes) {
  for (const Sender sender : {Sender::client, Sender::server}) {
    for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
      const auto decoded = decode_message(sender, c, bytes, kMessageEdge);
      if (!decoded || of_other_protocol(*decoded)) continue;
      const EncodedMessage again = encode_message(*decoded);
      REQUIRE(again.frame_class == c);
      const auto twice = decode_message(sender, c, *again.bytes, kMessageEdge);
      REQUIRE(twice.has_value());
      REQUIRE(*twice == *decoded);
    }
  }
}

}  // namespace

TEST_CASE("every message comes back from its bytes unchanged", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    for (int step = 0; step < 60; ++step) {
      CAPTURE(Catch::rngSeed(), kind, step);
      const Message message = random_message(rng, kind);
      const EncodedMessage encoded = encode_message(message);
      CHECK(encoded.frame_class == info_of(message).frame_class);
      const auto decoded = decode(message, encoded);
      if (!decoded) FAIL(decoded.error().what);
      REQUIRE(decoded->index() == kind);
      REQUIRE(*decoded == message);
    }
  }
}

TEST_CASE("a snapshot comes back unchanged from all encodings", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  for (int step = 0; step < 60; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const Message message = random_message(rng, 6);
    const auto& snapshot = std::get<ChunkSnapshot>(message);
    for (const ChunkEncoding encoding :
         {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
      const auto decoded = decode(message, encode_snapshot(snapshot.key, snapshot.chunk, encoding));
      REQUIRE(decoded.has_value());
      REQUIRE(*decoded == message);
      REQUIRE(digest_matches(std::get<ChunkSnapshot>(*decoded)));
    }
  }
}

TEST_CASE("no truncation of a message decodes to it", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    const Message message = random_message(rng, kind);
    const EncodedMessage encoded = encode_message(message);
    for (std::size_t size = 0; size < encoded.bytes->size(); ++size) {
      CAPTURE(Catch::rngSeed(), kind, size);
      // The buffer has exactly that size, so that sanitizers see a read behind its end.
      const Bytes cut(encoded.bytes->begin(),
                      encoded.bytes->begin() + static_cast<std::ptrdiff_t>(size));
      const auto decoded =
          decode_message(sender_of(message), encoded.frame_class, cut, kMessageEdge);
      // The last bytes may be padding.
      if (decoded) REQUIRE((size + 8 > encoded.bytes->size() && *decoded == message));
    }
  }
}

TEST_CASE("a flipped byte gives an error or a valid message", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    const EncodedMessage encoded = encode_message(random_message(rng, kind));
    Bytes bytes = *encoded.bytes;
    const std::size_t step = 1 + bytes.size() / 400;
    for (std::size_t at = rng.below(static_cast<std::uint32_t>(step)); at < bytes.size();
         at += step) {
      CAPTURE(Catch::rngSeed(), kind, at);
      const std::uint8_t before = bytes[at];
      for (const unsigned flip : {0x01u, 0x80u, 0xffu, 1u + rng.below(255)}) {
        bytes[at] = static_cast<std::uint8_t>(before ^ flip);
        survives(bytes);
      }
      bytes[at] = before;
    }
  }
}

TEST_CASE("bytes after a message change nothing", "[protocol][property]") {
  // FlatBuffers reads by offsets: bytes without an offset to them are not read.
  SplitMix64 rng{Catch::rngSeed() + 4};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    const Message message = random_message(rng, kind);
    const EncodedMessage encoded = encode_message(message);
    Bytes longer = *encoded.bytes;
    longer.push_back(0xa5);
    const auto decoded =
        decode_message(sender_of(message), encoded.frame_class, longer, kMessageEdge);
    REQUIRE(decoded.has_value());
    CHECK(*decoded == message);
  }
}

TEST_CASE("a message is refused from the wrong side and in the wrong class",
          "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 5};
  for (std::size_t kind = 0; kind < kMessageKinds; ++kind) {
    CAPTURE(kind);
    const Message message = random_message(rng, kind);
    const EncodedMessage encoded = encode_message(message);
    const bool either_side = std::holds_alternative<Goodbye>(message);
    for (const Sender sender : {Sender::client, Sender::server}) {
      for (const FrameClass c : {FrameClass::control, FrameClass::edits, FrameClass::chunks}) {
        const auto decoded = decode_message(sender, c, *encoded.bytes, kMessageEdge);
        const bool right =
            (either_side || sender == sender_of(message)) && c == encoded.frame_class;
        CHECK(decoded.has_value() == right);
      }
    }
  }
}

}  // namespace runstone::test
