// Seeded messages of every kind, with all fields drawn, valid for a world of chunk edge
// kMessageEdge.
#pragma once
#include <cstddef>
#include <variant>

#include "common/core/hash.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::test {

inline constexpr std::uint16_t kMessageEdge = 16;
inline constexpr std::size_t kMessageKinds = std::variant_size_v<Message>;

/// Returns a message of the kind with this index in Message. Requires kind < kMessageKinds.
Message random_message(SplitMix64& rng, std::size_t kind);

/// Returns a side that may send the message (for a goodbye: the client).
Sender sender_of(const Message& message);

/// Decodes a message as the other side would.
Result<Message> decode(const Message& kind, const EncodedMessage& encoded);

}  // namespace runstone::test
