#include "protocol/codec/message_table.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <string>
#include <vector>

#include "protocol/schema/runstone_generated.h"
#include "tests/support/codec/random_message.hpp"

namespace runstone::test {
namespace {

const char* text_of(SentBy sent_by) {
  if (sent_by == SentBy::both) return "both";
  return sent_by == SentBy::client ? "client" : "server";
}

const char* text_of(FrameClass frame_class) {
  if (frame_class == FrameClass::control) return "control";
  return frame_class == FrameClass::edits ? "edits" : "chunks";
}

const char* text_of(const std::optional<SessionStage>& stage) {
  if (!stage) return "any";
  if (*stage == SessionStage::open) return "open";
  return *stage == SessionStage::greeting ? "greeting" : "authenticating";
}

const char* text_of_feature(std::uint64_t feature) {
  if (feature == 0) return "–";
  if (feature == kFeatureRights) return "rights";
  if (feature == kFeatureChat) return "chat";
  if (feature == kFeatureKeyTransfer) return "key transfer";
  if (feature == kFeatureMaterials) return "materials";
  if (feature == kFeatureLogMarks) return "log marks";
  if (feature == kFeatureRestorePreview) return "restore preview";
  if (feature == kFeaturePreviews) return "previews";
  if (feature == kFeatureServers) return "servers";
  if (feature == kFeatureResume) return "resume";
  if (feature == kFeatureServerList) return "server list";
  if (feature == kFeatureBuilds) return "builds";
  if (feature == kFeatureShapes) return "shapes";
  if (feature == kFeatureTextures) return "textures";
  if (feature == kFeatureWorldTime) return "world time";
  if (feature == kFeatureChatWithdrawal) return "chat withdrawal";
  if (feature == kFeatureVeil) return "veil";
  return feature == kFeatureCommands ? "commands" : "receive ack";
}

/// Returns the row of docs/protocol.md up to the meaning, which is free text.
std::string row_of(MessageKind kind) {
  const MessageInfo& info = info_of(kind);
  return "| " + std::to_string(kind + 1) + " | `" + info.name + "` | " + text_of(info.sent_by) +
         " | " + text_of(info.frame_class) + " | " + text_of(info.stage) + " | " +
         text_of_feature(info.feature) + " |";
}

/// Returns the rows of the table of messages in docs/protocol.md.
std::vector<std::string> rows_of_the_page() {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/protocol.md");
  std::vector<std::string> rows;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (is_inside && !line.starts_with("| ")) break;
    if (is_inside && !line.starts_with("| --")) rows.push_back(line);
    if (line.starts_with("| number | message | sender | class | stage | feature |"))
      is_inside = true;
  }
  return rows;
}

std::optional<GoodbyeReason> reason(const Message& message, Sender sender, SessionStage stage,
                                    std::uint64_t features = 0) {
  const auto refusal = refusal_of(info_of(message), sender, stage, features);
  return refusal ? std::optional(refusal->reason) : std::nullopt;
}

}  // namespace

TEST_CASE("the table has the names, the numbers and the order of the schema", "[protocol]") {
  const char* const* names = wire::EnumNamesKind();
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    REQUIRE(names[kind] != nullptr);
    CHECK(std::string(info_of(kind).name) == names[kind]);
    CHECK(names[kind] == wire::EnumNameKind(static_cast<wire::Kind>(wire_number(kind))));
  }
  CHECK(names[kMessageKindCount] == nullptr);
}

TEST_CASE("an encoded message has its kind, and the kind decides the class", "[protocol]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const Message message = random_message(rng, kind);
    CAPTURE(info_of(kind).name);
    REQUIRE(message.index() == kind);
    const EncodedMessage encoded = encode_message(message);
    CHECK(encoded.kind == kind);
    CHECK(class_of(encoded) == info_of(kind).frame_class);
  }
  CHECK(kKindOf<Hello> == 0);
  CHECK(kKindOf<Chunks> == Message(Chunks{}).index());
  CHECK(kKindOf<VeiledCommit> == kMessageKindCount - 2);
  CHECK(kKindOf<VeilPatches> == kMessageKindCount - 1);
}

TEST_CASE("every client message fits a class that clients may use", "[protocol]") {
  for (const MessageInfo& info : kMessageTable) {
    CAPTURE(info.name);
    if (may_send(info, Sender::client))
      CHECK(message_bytes_max(Sender::client, info.frame_class) != 0);
    CHECK((info.feature & ~(kFeaturesKnown | kFeatureServers | kFeatureVeil)) == 0);
  }
}

TEST_CASE("players are not offered the messages between servers", "[protocol]") {
  CHECK((kFeaturesKnown & kFeatureServers) == 0);
  for (const MessageInfo& info : kMessageTable) {
    CAPTURE(info.name);
    if (info.feature != kFeatureServers) continue;
    for (const Sender sender : {Sender::client, Sender::server}) {
      const auto refusal_with = [&](std::uint64_t features) {
        return refusal_of(info, sender, SessionStage::open, features);
      };
      CHECK(refusal_with(kFeatureServers).has_value() != may_send(info, sender));
      REQUIRE(refusal_with(kFeaturesKnown).has_value());
      CHECK(refusal_with(kFeaturesKnown)->reason == GoodbyeReason::unexpected_message);
    }
  }
}

TEST_CASE("no server offers the veil, because none sends it", "[protocol][veil]") {
  CHECK((kFeaturesKnown & kFeatureVeil) == 0);
  const auto refusal = refusal_of(info_of(kKindOf<VeiledCommit>), Sender::server,
                                  SessionStage::open, kFeaturesKnown);
  REQUIRE(refusal.has_value());
  CHECK(refusal->reason == GoodbyeReason::unexpected_message);
}

TEST_CASE("the protocol page shows the table of messages", "[protocol]") {
  const std::vector<std::string> rows = rows_of_the_page();
  REQUIRE(rows.size() == kMessageKindCount);
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    const std::string row = row_of(kind);
    CHECK(rows[kind].substr(0, row.size()) == row);
  }
}

TEST_CASE("a server accepts a message in its stage and refuses it in the others", "[protocol]") {
  using enum SessionStage;
  constexpr auto kEarly = GoodbyeReason::not_authenticated;
  constexpr auto kUnexpected = GoodbyeReason::unexpected_message;
  const auto from_client = [](const Message& message, SessionStage stage) {
    return reason(message, Sender::client, stage);
  };
  CHECK(from_client(Hello{}, greeting) == std::nullopt);
  CHECK(from_client(Hello{}, authenticating) == kUnexpected);
  CHECK(from_client(Hello{}, open) == kUnexpected);
  CHECK(from_client(ClientAuth{}, greeting) == kUnexpected);
  CHECK(from_client(ClientAuth{}, authenticating) == std::nullopt);
  CHECK(from_client(ClientAuth{}, open) == kUnexpected);
  CHECK(from_client(EditRequest{}, greeting) == kEarly);
  CHECK(from_client(EditRequest{}, authenticating) == kEarly);
  CHECK(from_client(EditRequest{}, open) == std::nullopt);
  for (const SessionStage stage : {greeting, authenticating, open}) {
    CHECK(from_client(Goodbye{}, stage) == std::nullopt);
    CHECK(from_client(Commit{}, stage) == kUnexpected);
  }
}

TEST_CASE("a client accepts messages of the open session while it is authenticating",
          "[protocol]") {
  using enum SessionStage;
  constexpr auto kUnexpected = GoodbyeReason::unexpected_message;
  const auto from_server = [](const Message& message, SessionStage stage) {
    return reason(message, Sender::server, stage);
  };
  CHECK(from_server(Welcome{}, greeting) == std::nullopt);
  CHECK(from_server(Welcome{}, authenticating) == kUnexpected);
  CHECK(from_server(SessionAccepted{}, greeting) == kUnexpected);
  CHECK(from_server(SessionAccepted{}, authenticating) == std::nullopt);
  CHECK(from_server(SessionAccepted{}, open) == kUnexpected);
  CHECK(from_server(PlayerPoses{}, greeting) == kUnexpected);
  CHECK(from_server(PlayerPoses{}, authenticating) == std::nullopt);
  CHECK(from_server(PlayerPoses{}, open) == std::nullopt);
  CHECK(from_server(View{}, open) == kUnexpected);
}

TEST_CASE("a message needs its feature in force, on both sides", "[protocol]") {
  constexpr auto kOpen = SessionStage::open;
  constexpr auto kUnexpected = GoodbyeReason::unexpected_message;
  CHECK(reason(CommandRequest{}, Sender::client, kOpen, kFeatureCommands) == std::nullopt);
  CHECK(reason(CommandRequest{}, Sender::client, kOpen, kFeatureReceiveAck) == kUnexpected);
  CHECK(reason(CommandOutput{}, Sender::server, kOpen, kFeaturesKnown) == std::nullopt);
  CHECK(reason(CommandOutput{}, Sender::server, kOpen, 0) == kUnexpected);
  CHECK(reason(ReceiveAck{}, Sender::client, kOpen, kFeatureReceiveAck) == std::nullopt);
  CHECK(reason(ReceiveAck{}, Sender::client, kOpen, kFeatureCommands) == kUnexpected);
  CHECK(reason(Ping{}, Sender::client, kOpen, 0) == std::nullopt);
  for (const Sender sender : {Sender::client, Sender::server}) {
    CHECK(reason(Relay{}, sender, kOpen, kFeatureServers) == std::nullopt);
    CHECK(reason(RelayClose{}, sender, kOpen, kFeatureServers) == std::nullopt);
    CHECK(reason(Relay{}, sender, kOpen, kFeaturesKnown) == kUnexpected);
  }
  CHECK(reason(FollowRequest{}, Sender::client, kOpen, kFeatureServers) == std::nullopt);
  CHECK(reason(FollowRequest{}, Sender::server, kOpen, kFeatureServers) == kUnexpected);
}

}  // namespace runstone::test
