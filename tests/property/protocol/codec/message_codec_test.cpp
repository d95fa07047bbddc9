#include <catch2/catch.hpp>

#include "protocol/codec/chunk_entries.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/support/codec/random_message.hpp"

namespace runstone::test {
namespace {

/// Returns true for a Hello or Welcome of another version: it decodes to its version alone.
bool of_other_protocol(const Message& message) {
  if (const auto* hello = std::get_if<Hello>(&message)) return hello->protocol != kProtocolVersion;
  if (const auto* welcome = std::get_if<Welcome>(&message))
    return welcome->protocol != kProtocolVersion;
  return false;
}

/// Decodes altered bytes as this kind, from each side that may send it. The result is an error, or
/// a struct that encodes to bytes which decode to it again.
void survives(MessageKind kind, const Bytes& bytes) {
  for (const Sender sender : {Sender::client, Sender::server}) {
    if (!may_send(info_of(kind), sender)) continue;
    const auto decoded = decode_message(sender, kind, bytes, kMessageEdge);
    if (!decoded || of_other_protocol(*decoded)) continue;
    REQUIRE(decoded->index() == kind);
    const EncodedMessage again = encode_message(*decoded);
    REQUIRE(again.kind == kind);
    const auto twice = decode_message(sender, kind, *again.bytes, kMessageEdge);
    REQUIRE(twice.has_value());
    REQUIRE(*twice == *decoded);
  }
}

}  // namespace

TEST_CASE("every message comes back from its bytes unchanged", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    for (int step = 0; step < 60; ++step) {
      CAPTURE(Catch::rngSeed(), kind, step);
      const Message message = random_message(rng, kind);
      const EncodedMessage encoded = encode_message(message);
      CHECK(encoded.kind == kind);
      const auto decoded = decode(encoded);
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
    for (const ChunkAnswer& answer : random_message<Chunks>(rng).chunks) {
      const auto* snapshot = std::get_if<ChunkSnapshot>(&answer);
      if (snapshot == nullptr) continue;
      for (const ChunkEncoding encoding :
           {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
        const ChunkEntry entry = encode_snapshot(snapshot->key, snapshot->chunk, encoding);
        const auto decoded = decode(join_entries(7, {&entry, 1}));
        REQUIRE(decoded.has_value());
        REQUIRE(*decoded == Message(Chunks{7, {*snapshot}}));
        const auto& chunks = std::get<Chunks>(*decoded).chunks;
        REQUIRE(digest_matches(std::get<ChunkSnapshot>(chunks[0])));
      }
    }
  }
}

TEST_CASE("no truncation of a message decodes to it", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const Message message = random_message(rng, kind);
    const EncodedMessage encoded = encode_message(message);
    for (std::size_t size = 0; size < encoded.bytes->size(); ++size) {
      CAPTURE(Catch::rngSeed(), kind, size);
      // The buffer has exactly that size, so that sanitizers see a read behind its end.
      const Bytes cut(encoded.bytes->begin(),
                      encoded.bytes->begin() + static_cast<std::ptrdiff_t>(size));
      const auto decoded = decode_message(sender_of(kind), kind, cut, kMessageEdge);
      // The last bytes may be padding.
      if (decoded) REQUIRE((size + 8 > encoded.bytes->size() && *decoded == message));
    }
  }
}

TEST_CASE("a flipped byte gives an error or a valid message", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const EncodedMessage encoded = encode_message(random_message(rng, kind));
    Bytes bytes = *encoded.bytes;
    const std::size_t step = 1 + bytes.size() / 400;
    for (std::size_t at = rng.below(static_cast<std::uint32_t>(step)); at < bytes.size();
         at += step) {
      CAPTURE(Catch::rngSeed(), kind, at);
      const std::uint8_t before = bytes[at];
      for (const unsigned flip : {0x01u, 0x80u, 0xffu, 1u + rng.below(255)}) {
        bytes[at] = static_cast<std::uint8_t>(before ^ flip);
        survives(kind, bytes);
      }
      bytes[at] = before;
    }
  }
}

TEST_CASE("bytes after a message change nothing", "[protocol][property]") {
  // FlatBuffers reads by offsets: bytes without an offset to them are not read.
  SplitMix64 rng{Catch::rngSeed() + 4};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const Message message = random_message(rng, kind);
    const EncodedMessage encoded = encode_message(message);
    Bytes longer = *encoded.bytes;
    longer.push_back(0xa5);
    const auto decoded = decode_message(sender_of(kind), kind, longer, kMessageEdge);
    REQUIRE(decoded.has_value());
    CHECK(*decoded == message);
  }
}

TEST_CASE("the bytes of one kind under the number of another give an error or a valid message",
          "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 5};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    CAPTURE(Catch::rngSeed(), kind);
    const EncodedMessage encoded = encode_message(random_message(rng, kind));
    for (MessageKind other = 0; other < kMessageKindCount; ++other) survives(other, *encoded.bytes);
  }
}

}  // namespace runstone::test
