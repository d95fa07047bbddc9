// The table of messages: everything that is known of a message by its kind alone. The decoder, the
// frames, the sessions of both sides and the table in docs/protocol.md follow from it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>

#include "protocol/codec/messages.hpp"

namespace runstone {

/// Index of a message's type in Message, in kMessageTable and, less one, in the union Body of the
/// schema.
using MessageKind = std::size_t;
inline constexpr std::size_t kMessageKindCount = std::variant_size_v<Message>;

/// How far the handshake has come, counted by each side for itself.
enum class SessionStage : std::uint8_t {
  greeting,        // the server waits for Hello, the client for Welcome
  authenticating,  // the server waits for ClientAuth, the client for SessionAccepted
  open,            // the handshake is complete
};

enum class SentBy : std::uint8_t { client, server, both };

struct MessageInfo {
  const char* name;  // of the message's table in the schema
  SentBy sent_by;
  FrameClass frame_class;
  std::optional<SessionStage> stage;  // in which the receiver must be; nullopt: any
  std::uint64_t feature;              // its bit must be in force; 0: the message needs no feature
};

/// Each class keeps the order of its messages, and this decides what travels where:
///   - edits: SessionAccepted comes first, and Durable never overtakes the commits that it covers;
///   - chunks: the last message about a chunk arrives last, and HistoryState precedes the chunks of
///     its view;
///   - control: the rest.
inline constexpr std::array<MessageInfo, kMessageKindCount> kMessageTable = [] {
  using enum SentBy;
  using enum SessionStage;
  constexpr FrameClass kControl = FrameClass::control;
  constexpr FrameClass kEdits = FrameClass::edits;
  constexpr FrameClass kChunks = FrameClass::chunks;
  return std::array<MessageInfo, kMessageKindCount>{{
      {"Hello", client, kControl, greeting, 0},
      {"Welcome", server, kControl, greeting, 0},
      {"ClientAuth", client, kControl, authenticating, 0},
      {"SessionAccepted", server, kEdits, authenticating, 0},
      {"View", client, kControl, open, 0},
      {"ChunkRequest", client, kControl, open, 0},
      {"Chunk", server, kChunks, open, 0},
      {"EditRequest", client, kEdits, open, 0},
      {"Commit", server, kEdits, open, 0},
      {"Reject", server, kEdits, open, 0},
      {"Durable", server, kEdits, open, 0},
      {"DigestCheck", server, kControl, open, 0},
      {"Move", client, kControl, open, 0},
      {"PlayerPoses", server, kControl, open, 0},
      {"PlayerList", server, kControl, open, 0},
      {"Ping", client, kControl, open, 0},
      {"Pong", server, kControl, open, 0},
      {"Goodbye", both, kControl, std::nullopt, 0},
      {"ChunkUnavailable", server, kChunks, open, 0},
      {"HistoryRequest", client, kControl, open, 0},
      {"HistoryState", server, kChunks, open, 0},
      {"CommandRequest", client, kControl, open, kFeatureCommands},
      {"CommandOutput", server, kControl, open, kFeatureCommands},
      {"ReceiveAck", client, kControl, open, kFeatureReceiveAck},
      {"UniformChunks", server, kChunks, open, 0},
      {"CachedChunks", client, kControl, open, 0},
      {"ChunksNotModified", server, kChunks, open, 0},
      {"ChunkEdits", server, kChunks, open, 0},
  }};
}();

/// Requires kind < kMessageKindCount.
constexpr const MessageInfo& info_of(MessageKind kind) { return kMessageTable[kind]; }
inline const MessageInfo& info_of(const Message& message) { return info_of(message.index()); }

/// Returns the kind of a message that encode_message() made or decode_message() accepted. Verifies
/// nothing. Cost: O(1).
MessageKind kind_of(ByteView message);

/// Returns true if this side may send the message.
constexpr bool may_send(const MessageInfo& info, Sender sender) {
  return info.sent_by == SentBy::both ||
         (info.sent_by == SentBy::client) == (sender == Sender::client);
}

/// Why a session ends although the message decoded.
struct Refusal {
  GoodbyeReason reason;
  const char* text;
};

/// Returns nullopt if a session at `stage` with these features in force accepts the message from
/// `sender`, otherwise the goodbye that ends it:
///   - not_authenticated if a client sends a message of the open session too early;
///   - unexpected_message if the sender, the stage or the feature is wrong.
/// A client accepts messages of the open session while it is authenticating: there is no order
/// between classes, so they may overtake SessionAccepted.
std::optional<Refusal> refusal_of(const MessageInfo& info, Sender sender, SessionStage stage,
                                  std::uint64_t features);

}  // namespace runstone
