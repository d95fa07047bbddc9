// MessageKind: which of the schema's messages bytes are, without decoding them; and how many bytes of each passed.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// Index in Message.
using MessageKind = std::size_t;
inline constexpr std::size_t kMessageKindCount = std::variant_size_v<Message>;

/// The kind of a message that encode_message() made or that was decoded without an error: nothing is verified here. O(1).
MessageKind kind_of(ByteView message);
/// The class that messages of this kind travel in: see frame_class_of(). Requires kind < kMessageKindCount.
FrameClass class_of_kind(MessageKind kind);
/// The name in the schema and docs/protocol.md: "Commit". Requires kind < kMessageKindCount.
const char* name_of_kind(MessageKind kind);

/// Messages of one kind that passed one way.
struct KindTraffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;   // without frame headers
  std::uint64_t frames = 0;  // that carried them
  KindTraffic& operator+=(const KindTraffic& other) {
    messages += other.messages;
    bytes += other.bytes;
    frames += other.frames;
    return *this;
  }
  friend bool operator==(const KindTraffic&, const KindTraffic&) = default;
};
using Traffic = std::array<KindTraffic, kMessageKindCount>;
/// Of all kinds that travel in this class.
KindTraffic of_class(const Traffic& traffic, FrameClass frame_class);

}  // namespace runstone
