#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>

#include "common/core/hash.hpp"
#include "protocol/codec/frame.hpp"
#include "protocol/codec/message_table.hpp"

namespace runstone::test {
namespace {

struct Sent {
  MessageKind kind = 0;
  Bytes body;
  friend bool operator==(const Sent&, const Sent&) = default;
};
/// Messages by class, each in the order in which they were sent.
using Messages = std::array<std::vector<Sent>, kFrameClassCount>;

/// Returns a kind that the sender may send.
MessageKind random_kind(SplitMix64& rng, Sender sender) {
  for (;;) {
    const MessageKind kind = rng.below(static_cast<std::uint32_t>(kMessageKindCount));
    if (may_send(info_of(kind), sender)) return kind;
  }
}

Bytes random_body(SplitMix64& rng, std::size_t bytes_max) {
  const std::uint32_t size =
      rng.below(5) == 0 ? rng.below(static_cast<std::uint32_t>(bytes_max)) : rng.below(300);
  Bytes body(1 + size);
  for (auto& byte : body) byte = static_cast<std::uint8_t>(rng.next());
  return body;
}

Messages random_messages(SplitMix64& rng, Sender sender) {
  Messages out;
  for (std::uint32_t left = rng.below(20); left > 0; --left) {
    const MessageKind kind = random_kind(rng, sender);
    const FrameClass frame_class = info_of(kind).frame_class;
    const std::size_t bytes_max =
        std::min<std::size_t>(message_bytes_max(sender, frame_class), 100'000);
    out[static_cast<std::size_t>(frame_class)].push_back({kind, random_body(rng, bytes_max)});
  }
  return out;
}

/// Returns a stream with fragments of random size and randomly interleaved classes.
Bytes random_stream(SplitMix64& rng, const Messages& messages) {
  Bytes stream;
  FrameWriter writer;
  std::array<std::size_t, kFrameClassCount> message{}, at{};
  for (;;) {
    std::vector<std::size_t> unfinished;
    for (std::size_t c = 0; c < messages.size(); ++c) {
      if (message[c] < messages[c].size()) unfinished.push_back(c);
    }
    if (unfinished.empty()) return stream;
    const std::size_t c = unfinished[rng.below(static_cast<std::uint32_t>(unfinished.size()))];
    const auto& [kind, body] = messages[c][message[c]];
    const std::size_t left = body.size() - at[c];
    const std::size_t size =
        std::min({left, kFragmentBytesMax,
                  rng.below(3) == 0 ? std::size_t{1} + rng.below(20) : kFragmentBytesMax});
    const FrameHeader header = writer.next(kind, size, size < left);
    stream.insert(stream.end(), header.begin(), header.end());
    const auto from = body.begin() + static_cast<std::ptrdiff_t>(at[c]);
    stream.insert(stream.end(), from, from + static_cast<std::ptrdiff_t>(size));
    at[c] += size;
    if (at[c] == body.size()) {
      ++message[c];
      at[c] = 0;
    }
  }
}

/// Feeds the stream in pieces. Returns the messages, or nullopt if the reader refused it.
std::optional<Messages> read_in_pieces(SplitMix64& rng, Sender sender, ByteView stream) {
  FrameReader reader(sender);
  Messages out;
  const auto take = [&out](MessageKind kind, ByteView body) -> Result<void> {
    CHECK(reinterpret_cast<std::uintptr_t>(body.data()) % 16 == 0);
    out[static_cast<std::size_t>(info_of(kind).frame_class)].push_back(
        {kind, Bytes(body.begin(), body.end())});
    return {};
  };
  const std::uint32_t piece_max = 1 + (rng.below(2) == 0 ? rng.below(30) : rng.below(40'000));
  while (!stream.empty()) {
    const std::size_t size = std::min<std::size_t>(stream.size(), 1 + rng.below(piece_max));
    const Bytes piece(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    if (!reader.feed(piece, take)) return std::nullopt;
    stream = stream.subspan(size);
  }
  return out;
}

}  // namespace

TEST_CASE("messages survive any interleaving of classes and any split of the stream",
          "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 150; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const Sender sender = rng.below(2) == 0 ? Sender::client : Sender::server;
    const Messages sent = random_messages(rng, sender);
    const auto received = read_in_pieces(rng, sender, random_stream(rng, sent));
    REQUIRE(received.has_value());
    REQUIRE(*received == sent);
  }
}

TEST_CASE("a lost, repeated or swapped frame is noticed at once", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  for (int step = 0; step < 100; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    std::vector<Bytes> frames;
    FrameWriter writer;
    for (int i = 0; i < 6; ++i) {
      const Bytes body = random_body(rng, 200);
      const FrameHeader header = writer.next(random_kind(rng, Sender::server), body.size(), false);
      frames.emplace_back(header.begin(), header.end());
      frames.back().insert(frames.back().end(), body.begin(), body.end());
    }
    const auto at = frames.begin() + static_cast<std::ptrdiff_t>(rng.below(5));
    const std::uint32_t harm = rng.below(3);
    if (harm == 0) frames.erase(at);
    if (harm == 1) frames.insert(at, Bytes(*at));
    if (harm == 2) std::swap(*at, *(at + 1));
    Bytes stream;
    for (const Bytes& frame : frames) stream.insert(stream.end(), frame.begin(), frame.end());
    REQUIRE_FALSE(read_in_pieces(rng, Sender::server, stream).has_value());
  }
}

TEST_CASE("a flipped byte of a frame header never crashes the reader", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  for (int step = 0; step < 300; ++step) {
    const Messages sent = random_messages(rng, Sender::server);
    Bytes stream = random_stream(rng, sent);
    if (stream.empty()) continue;
    const std::size_t at =
        rng.below(static_cast<std::uint32_t>(std::min<std::size_t>(stream.size(), 400)));
    stream[at] = static_cast<std::uint8_t>(stream[at] ^ (1u << rng.below(8)));
    const auto received = read_in_pieces(rng, Sender::server, stream);
    // The reader does not check bodies. A changed header never gives the same messages.
    if (received) CHECK(*received != sent);
  }
}

}  // namespace runstone::test
