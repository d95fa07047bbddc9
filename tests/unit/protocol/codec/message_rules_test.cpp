#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {

TEST_CASE("answers and texts are refused outside their bounds", "[protocol]") {
  const auto reject = [](std::uint64_t seq, std::uint8_t reason, const std::string& text) {
    return passes_from_server(
        [&](auto& b) { return wire::CreateReject(b, seq, reason, b.CreateString(text)); },
        FrameClass::edits);
  };
  CHECK(reject(1, 1, std::string(256, 'x')));
  CHECK_FALSE(reject(0, 1, ""));
  CHECK_FALSE(reject(1, 0, ""));
  CHECK_FALSE(reject(1, kRejectReasonMax + 1, ""));
  CHECK_FALSE(reject(1, 1, std::string(257, 'x')));
  CHECK_FALSE(reject(1, 1, "\xed\xa0\x80"));

  const auto goodbye = [](std::uint16_t reason, const std::string& text) {
    return passes_from_client(
        [&](auto& b) { return wire::CreateGoodbye(b, reason, b.CreateString(text)); });
  };
  CHECK(goodbye(kGoodbyeReasonMax, ""));
  CHECK_FALSE(goodbye(0, ""));
  CHECK_FALSE(goodbye(kGoodbyeReasonMax + 1, ""));
  CHECK_FALSE(goodbye(1, "\t"));
  CHECK(passes_from_client(
      [](auto& b) { return wire::CreateGoodbye(b, 1); }));  // an absent text is empty

  CHECK_FALSE(
      passes_from_server([](auto& b) { return wire::CreateDurable(b, 0, 5); }, FrameClass::edits));
  const auto roster = [](const std::string& name) {
    return passes_from_server([&](auto& b) {
      const std::vector<Offset<wire::PlayerName>> names{
          wire::CreatePlayerName(b, 1, b.CreateString(name))};
      return wire::CreatePlayerList(b, b.CreateVector(names));
    });
  };
  CHECK(roster("bo"));
  CHECK_FALSE(roster(""));
  CHECK_FALSE(roster(std::string(33, 'b')));
  const auto audit = [](std::size_t count) {
    return passes_from_server([&](auto& b) {
      const wire::Key key(0, 0, 0, 0);
      const wire::Version version(1, 1);
      const wire::Digest digest(1, 1);
      const std::vector<Offset<wire::DigestCheckEntry>> entries(
          count, wire::CreateDigestCheckEntry(b, &key, &version, &digest));
      return wire::CreateDigestCheck(b, b.CreateVector(entries));
    });
  };
  CHECK(audit(0));
  CHECK(audit(kDigestCheckEntriesMax));
  CHECK_FALSE(audit(kDigestCheckEntriesMax + 1));
  CHECK_FALSE(passes_from_server([](auto& b) {
    const std::vector<Offset<wire::DigestCheckEntry>> empty{wire::CreateDigestCheckEntry(b)};
    return wire::CreateDigestCheck(b, b.CreateVector(empty));
  }));
}

TEST_CASE("the encoder cuts texts that are too long, between two characters", "[protocol]") {
  std::string text(kTextBytesMax - 1, 'x');
  text += "\xe2\x82\xac and more";
  for (const Message& message : {Message(Goodbye{GoodbyeReason::internal, text}),
                                 Message(Reject{1, RejectReason::busy, text})}) {
    const auto decoded = decode(message, encode_message(message));
    REQUIRE(decoded.has_value());
    const auto* goodbye = std::get_if<Goodbye>(&*decoded);
    CHECK((goodbye != nullptr ? goodbye->text : std::get<Reject>(*decoded).detail) ==
          std::string(kTextBytesMax - 1, 'x'));
  }
}

TEST_CASE("a message without a known body is refused", "[protocol]") {
  const auto with_type = [](std::uint8_t type, bool body) {
    FlatBufferBuilder b;
    Offset<void> table;
    if (body) table = wire::CreatePing(b, 5).Union();
    wire::MessageBuilder message(b);
    message.add_body_type(static_cast<wire::Body>(type));
    if (body) message.add_body(table);
    b.Finish(message.Finish(), "RUN1");
    return Bytes(b.GetBufferPointer(), b.GetBufferPointer() + b.GetSize());
  };
  const auto refused = [](const Bytes& bytes) {
    return !decode_message(Sender::client, FrameClass::control, bytes, kMessageEdge).has_value();
  };
  const auto ping = static_cast<std::uint8_t>(wire::Body::Ping);
  REQUIRE_FALSE(refused(with_type(ping, true)));
  CHECK(refused(with_type(ping, false)));
  CHECK(refused(with_type(0, true)));
  for (unsigned type = static_cast<unsigned>(wire::Body::MAX) + 1; type < 256; ++type)
    CHECK(refused(with_type(static_cast<std::uint8_t>(type), true)));
}

TEST_CASE("a buffer of another kind, or larger than its class, is refused", "[protocol]") {
  FlatBufferBuilder b;
  const Bytes other = message_of(b, wire::CreatePing(b, 5), "RUN2");
  CHECK_FALSE(decode_message(Sender::client, FrameClass::control, other, kMessageEdge).has_value());
  CHECK_FALSE(decode_message(Sender::client, FrameClass::control, {}, kMessageEdge).has_value());
  FlatBufferBuilder c;
  Bytes ping = message_of(c, wire::CreatePing(c, 5));
  ping.resize(kClientControlBytesMax);
  CHECK(decode_message(Sender::client, FrameClass::control, ping, kMessageEdge).has_value());
  ping.push_back(0);
  CHECK_FALSE(decode_message(Sender::client, FrameClass::control, ping, kMessageEdge).has_value());
}

TEST_CASE("reasons have the names and numbers of the protocol page", "[protocol]") {
  std::ifstream file(RUNSTONE_SOURCE_DIR "/docs/protocol.md");
  std::set<std::string> rows;  // "| `name` | number |"
  for (std::string line; std::getline(file, line);) {
    const auto number_ends = line.find(" |", line.find(" | ") + 3);
    if (line.starts_with("| `") && number_ends != std::string::npos)
      rows.insert(line.substr(0, number_ends));
  }
  const auto row = [](const char* name, unsigned number) {
    return "| `" + std::string(name) + "` | " + std::to_string(number);
  };
  for (unsigned i = 1; i <= kRejectReasonMax; ++i) {
    CHECK(rows.contains(row(to_string(static_cast<RejectReason>(i)), i)));
  }
  for (unsigned i = 1; i <= kGoodbyeReasonMax; ++i) {
    CHECK(rows.contains(row(to_string(static_cast<GoodbyeReason>(i)), i)));
  }
  CHECK(rows.contains(row(to_string(UnavailableReason::damaged), 1)));
}

TEST_CASE("no two reasons have the same name", "[protocol]") {
  std::vector<std::string> names;
  for (unsigned i = 1; i <= kRejectReasonMax; ++i)
    names.emplace_back(to_string(static_cast<RejectReason>(i)));
  for (unsigned i = 1; i <= kGoodbyeReasonMax; ++i)
    names.emplace_back(to_string(static_cast<GoodbyeReason>(i)));
  std::sort(names.begin(), names.end());
  CHECK(std::unique(names.begin(), names.end()) == names.end());
  CHECK(std::count(names.begin(), names.end(), "unknown") == 0);
}

}  // namespace runstone::test
