// Traffic: how many messages, frames and bytes of each kind passed in one direction.
#pragma once
#include <array>
#include <cstdint>

#include "protocol/codec/message_table.hpp"

namespace runstone {

/// The traffic of one kind of message, or of several kinds added up.
struct KindTraffic {
  std::uint64_t messages = 0;
  std::uint64_t bytes = 0;   // of messages, without frame headers
  std::uint64_t frames = 0;  // that carried the messages
  KindTraffic& operator+=(const KindTraffic& other) {
    messages += other.messages;
    bytes += other.bytes;
    frames += other.frames;
    return *this;
  }
  friend bool operator==(const KindTraffic&, const KindTraffic&) = default;
};
using Traffic = std::array<KindTraffic, kMessageKindCount>;

/// Returns the sum over the kinds that travel in this class.
inline KindTraffic of_class(const Traffic& traffic, FrameClass frame_class) {
  KindTraffic sum;
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    if (info_of(kind).frame_class == frame_class) sum += traffic[kind];
  }
  return sum;
}

}  // namespace runstone
