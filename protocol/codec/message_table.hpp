// The table of messages: everything that is known of a message by its kind alone. The decoder, the
// frames, the sessions of both sides and the table in docs/protocol.md follow from it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <variant>

#include "protocol/codec/messages.hpp"

namespace runstone {

inline constexpr std::size_t kMessageKindCount = std::variant_size_v<Message>;

/// How far the handshake has come, counted by each side for itself.
enum class SessionStage : std::uint8_t {
  greeting,        // the server waits for Hello, the client for Welcome
  authenticating,  // the server waits for ClientAuth, the client for SessionAccepted
  open,            // the handshake is complete
};

enum class SentBy : std::uint8_t { client, server, both };

struct MessageInfo {
  const char* name;  // of the message's table, and of its number in the enum Kind, in the schema
  SentBy sent_by;
  FrameClass frame_class;
  std::optional<SessionStage> stage;  // in which the receiver must be; nullopt: any
  std::uint64_t feature;              // its bit must be in force; 0: the message needs no feature
};

/// Each class keeps the order of its messages, and this decides what travels where:
///   - edits: SessionAccepted comes first, and Durable never overtakes the commits that it covers;
///   - chunks: the last message about a chunk arrives last, and ViewState precedes the chunks of
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
      {"Chunks", server, kChunks, open, 0},
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
      {"ViewState", server, kChunks, open, 0},
      {"CommandRequest", client, kControl, open, kFeatureCommands},
      {"CommandOutput", server, kControl, open, kFeatureCommands},
      {"ReceiveAck", client, kControl, open, kFeatureReceiveAck},
      {"UniformChunks", server, kChunks, open, 0},
      {"CachedChunks", client, kControl, open, 0},
      {"ChunksNotModified", server, kChunks, open, 0},
      {"Permissions", server, kControl, open, kFeatureRights},
      {"ProtectedGround", server, kControl, open, kFeatureRights},
      {"ChatRequest", client, kControl, open, kFeatureChat},
      {"ChatLines", server, kControl, open, kFeatureChat},
      {"KeyRequest", client, kControl, authenticating, kFeatureKeyTransfer},
      {"SealedKey", server, kControl, authenticating, kFeatureKeyTransfer},
      {"KeyDeposit", client, kControl, authenticating, kFeatureKeyTransfer},
      {"KeyDeposited", server, kControl, authenticating, kFeatureKeyTransfer},
      {"MaterialsAdded", server, kEdits, open, kFeatureMaterials},
      {"LogMarksRequest", client, kControl, open, kFeatureLogMarks},
      {"LogMarks", server, kControl, open, kFeatureLogMarks},
      {"RestorePreview", server, kControl, open, kFeatureRestorePreview},
      {"PreviewShare", client, kControl, open, kFeaturePreviews},
      {"PlayerPreview", server, kControl, open, kFeaturePreviews},
      {"FollowRequest", client, kEdits, open, kFeatureServers},
      {"FollowAnswer", server, kEdits, open, kFeatureServers},
      {"LogPart", server, kEdits, open, kFeatureServers},
      {"RelayOpen", client, kEdits, open, kFeatureServers},
      {"Relay", both, kEdits, open, kFeatureServers},
      {"RelayClose", both, kEdits, open, kFeatureServers},
      {"RelayCharge", server, kControl, open, kFeatureServers},
      {"Resume", server, kEdits, open, kFeatureResume},
      {"Resumed", client, kEdits, open, kFeatureResume},
      {"Servers", server, kEdits, open, kFeatureServerList},
      {"BuildsRequest", client, kControl, open, kFeatureBuilds},
      {"Builds", server, kControl, open, kFeatureBuilds},
      {"BuildPieceRequest", client, kControl, open, kFeatureBuilds},
      {"BuildPiece", server, kControl, open, kFeatureBuilds},
      {"BuildOffer", client, kEdits, open, kFeatureBuilds},
      {"BuildUpload", client, kEdits, open, kFeatureBuilds},
      {"BuildAnswer", server, kControl, open, kFeatureBuilds},
      {"ShapesGiven", server, kEdits, open, kFeatureShapes},
      {"TexturesGiven", server, kEdits, open, kFeatureTextures},
      {"TexturesWanted", client, kControl, open, kFeatureTextures},
      {"TextureParts", server, kChunks, open, kFeatureTextures},
      {"WorldTime", server, kEdits, open, kFeatureWorldTime},
      {"ChatWithdrawn", server, kControl, open, kFeatureChatWithdrawal},
      {"VeiledCommit", server, kEdits, open, kFeatureVeil},
      {"VeilPatches", server, kEdits, open, kFeatureVeil},
  }};
}();

/// Requires kind < kMessageKindCount.
constexpr const MessageInfo& info_of(MessageKind kind) { return kMessageTable[kind]; }
inline const MessageInfo& info_of(const Message& message) { return info_of(message.index()); }

constexpr FrameClass class_of(const EncodedMessage& message) {
  return info_of(message.kind).frame_class;
}

/// Returns the number of the kind in frame headers and in the enum Kind of the schema.
constexpr std::uint8_t wire_number(MessageKind kind) { return static_cast<std::uint8_t>(kind + 1); }

/// The kind of a type of Message.
template <class T>
inline constexpr MessageKind kKindOf = [] {
  return []<class... Types>(std::variant<Types...>*) {
    MessageKind kind = 0;
    (void)((std::is_same_v<T, Types> || (++kind, false)) || ...);
    return kind;
  }(static_cast<Message*>(nullptr));
}();

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
