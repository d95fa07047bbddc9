// Seeded messages of every kind, with all fields drawn, valid for a world of chunk edge
// kMessageEdge.
#pragma once
#include <variant>

#include "common/core/hash.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::test {

inline constexpr std::uint16_t kMessageEdge = 16;

/// Returns a message of this kind. Requires kind < kMessageKindCount.
Message random_message(SplitMix64& rng, MessageKind kind);
template <class T>
T random_message(SplitMix64& rng) {
  return std::get<T>(random_message(rng, kKindOf<T>));
}

/// Returns a side that may send the kind (of Goodbye: the client).
Sender sender_of(MessageKind kind);

/// Decodes a message as the other side would.
Result<Message> decode(const EncodedMessage& encoded);

}  // namespace runstone::test
