#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "common/core/assert.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/handshake.hpp"
#include "protocol/codec/message_table.hpp"
#include "tests/conformance/vectors/vector_values.hpp"

namespace runstone::conformance {
namespace {

template <std::size_t N>
std::array<std::uint8_t, N> counting(std::uint8_t first) {
  std::array<std::uint8_t, N> out{};
  std::iota(out.begin(), out.end(), first);
  return out;
}

KeySeed seed_of(std::uint8_t byte) {
  KeySeed seed;
  seed.fill(byte);
  return seed;
}

/// The handshake of docs/protocol.md.
struct RecordedHandshake {
  KeySeed server_seed = seed_of(1), client_seed = seed_of(2);
  ChannelBinding binding = counting<32>(0xc0);
  Hello hello;
  Welcome welcome;
  ClientAuth auth;
  SessionAccepted accepted;

  explicit RecordedHandshake(bool is_encrypted) {
    hello.key = key_pair_of(client_seed).public_key;
    hello.instance = 0x0123456789abcdefULL;
    hello.nonce = counting<32>(0x80);
    hello.name = "Ren\xc3\xa9";
    hello.encodings = 3;
    hello.features = 0x8000000000000005ULL;
    welcome.world_id = counting<16>(0x10);
    welcome.epoch = 3;
    welcome.durable = 480;
    welcome.head = 499;
    welcome.chunk_edge = 32;
    welcome.heights = {-64, 192};
    welcome.spawn = {0.5, 70, -0.25};
    const auto stone =
        welcome.materials.add({"stone", {128, 128, 128, 255}, Visibility::opaque, std::nullopt});
    RUNSTONE_ASSERT(stone.has_value());
    welcome.server_key = key_pair_of(server_seed).public_key;
    welcome.challenge = counting<32>(0x40);
    welcome.encoding = ChunkEncoding::packed;
    welcome.edit_volume_max = 1'000'000;
    welcome.edit_budget = {100, 4'000};
    welcome.view_radius_max = 16;
    welcome.features = 5;
    const auto bound = is_encrypted ? std::optional(binding) : std::nullopt;
    welcome.signature = sign(key_pair_of(server_seed), server_transcript(hello, welcome, bound));
    auth.signature = sign(key_pair_of(client_seed), client_transcript(hello, welcome, bound));
    accepted.author = 7;
    accepted.resolved = 41;
  }
};

Json message_entry(const char* from, const Message& message) {
  const EncodedMessage encoded = encode_message(message);
  return {{"from", from},
          {"kind", wire_number(encoded.kind)},
          {"name", info_of(encoded.kind).name},
          {"bytes", to_hex(*encoded.bytes)}};
}

Json transcripts_of(bool is_encrypted) {
  const RecordedHandshake shake(is_encrypted);
  const auto bound = is_encrypted ? std::optional(shake.binding) : std::nullopt;
  return {{"name", is_encrypted ? "over TLS" : "without encryption"},
          {"server_seed", to_hex(shake.server_seed)},
          {"client_seed", to_hex(shake.client_seed)},
          {"channel_binding", is_encrypted ? to_hex(shake.binding) : ""},
          {"server_transcript", to_hex(server_transcript(shake.hello, shake.welcome, bound))},
          {"server_signature", to_hex(shake.welcome.signature)},
          {"client_transcript", to_hex(client_transcript(shake.hello, shake.welcome, bound))},
          {"client_signature", to_hex(shake.auth.signature)}};
}

/// Signatures that a client must refuse, over the transcript of the encrypted handshake.
Json refused_signatures() {
  const RecordedHandshake shake(true);
  const Bytes transcript = server_transcript(shake.hello, shake.welcome, shake.binding);
  Json out = Json::array();
  const auto add = [&](const char* name, const Signature& signature) {
    RUNSTONE_ASSERT(!verify(shake.welcome.server_key, transcript, signature));
    out.push_back({{"name", name}, {"signature", to_hex(signature)}});
  };
  Signature flipped = shake.welcome.signature;
  flipped[63] ^= 1;
  add("a bit differs", flipped);
  add("zeros", Signature{});
  add("that of the client", shake.auth.signature);
  add("made with another key", sign(key_pair_of(shake.client_seed), transcript));
  add("made without a channel binding", RecordedHandshake(false).welcome.signature);
  return out;
}

Json frame_headers() {
  FrameWriter writer;
  Json out = Json::array();
  const auto add = [&](const char* words, MessageKind kind, std::size_t bytes, bool more) {
    const FrameHeader header = writer.next(kind, bytes, more);
    out.push_back({{"of", words}, {"header", to_hex(header)}});
  };
  add("the first frame: 300 bytes of a Commit", kKindOf<Commit>, 300, false);
  add("the second one: 16,384 bytes of Chunks, more follow", kKindOf<Chunks>, 16'384, true);
  add("the third one: 1 byte of a Ping", kKindOf<Ping>, 1, false);
  return out;
}

}  // namespace

Json handshake_vectors() {
  const RecordedHandshake shake(true);
  Json messages =
      Json::array({message_entry("client", shake.hello), message_entry("server", shake.welcome),
                   message_entry("client", shake.auth), message_entry("server", shake.accepted)});
  return {{"format", "runstone handshake vectors 1"},
          {"messages", std::move(messages)},
          {"transcripts", Json::array({transcripts_of(true), transcripts_of(false)})},
          {"refused_server_signatures", refused_signatures()},
          {"frame_headers", frame_headers()}};
}

}  // namespace runstone::conformance
