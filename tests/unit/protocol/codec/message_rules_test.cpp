#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {

TEST_CASE("answers and texts are refused outside their bounds", "[protocol]") {
  const auto reject = [](std::uint64_t seq, std::uint8_t reason, const std::string& text) {
    return passes<Reject>(
        [&](auto& b) { return wire::CreateReject(b, seq, reason, b.CreateString(text)); });
  };
  CHECK(reject(1, 1, std::string(256, 'x')));
  CHECK_FALSE(reject(0, 1, ""));
  CHECK_FALSE(reject(1, 0, ""));
  CHECK_FALSE(reject(1, kRejectReasonMax + 1, ""));
  CHECK_FALSE(reject(1, 1, std::string(257, 'x')));
  CHECK_FALSE(reject(1, 1, "\xed\xa0\x80"));

  const auto goodbye = [](std::uint16_t reason, const std::string& text) {
    return passes<Goodbye>(
        [&](auto& b) { return wire::CreateGoodbye(b, reason, b.CreateString(text)); });
  };
  CHECK(goodbye(kGoodbyeReasonMax, ""));
  CHECK_FALSE(goodbye(0, ""));
  CHECK_FALSE(goodbye(kGoodbyeReasonMax + 1, ""));
  CHECK_FALSE(goodbye(1, "\t"));
  CHECK(passes<Goodbye>(
      [](auto& b) { return wire::CreateGoodbye(b, 1); }));  // an absent text is empty

  CHECK_FALSE(passes<Durable>([](auto& b) { return wire::CreateDurable(b, 0, 5); }));
  const auto list = [](const std::string& name, unsigned key_bytes = 32) {
    return passes<PlayerList>([&](auto& b) {
      const auto text = b.CreateString(name);
      const std::vector<Offset<wire::PlayerName>> names{
          wire::CreatePlayerName(b, 1, text, filled(b, key_bytes))};
      return wire::CreatePlayerList(b, b.CreateVector(names));
    });
  };
  CHECK(list("bo"));
  CHECK_FALSE(list(""));
  CHECK_FALSE(list(std::string(33, 'b')));
  CHECK_FALSE(list("bo", 31));
}

TEST_CASE("the encoder cuts texts that are too long, between two characters", "[protocol]") {
  std::string text(kTextBytesMax - 1, 'x');
  text += "\xe2\x82\xac and more";
  for (const Message& message : {Message(Goodbye{GoodbyeReason::internal, text}),
                                 Message(Reject{1, RejectReason::busy, text})}) {
    const auto decoded = decode(encode_message(message));
    REQUIRE(decoded.has_value());
    const auto* goodbye = std::get_if<Goodbye>(&*decoded);
    CHECK((goodbye != nullptr ? goodbye->text : std::get<Reject>(*decoded).detail) ==
          std::string(kTextBytesMax - 1, 'x'));
  }
}

TEST_CASE("bytes that are no buffer, or larger than their class allows, are refused",
          "[protocol]") {
  for (MessageKind kind = 0; kind < kMessageKindCount; ++kind) {
    CAPTURE(info_of(kind).name);
    const Sender sender = sender_of(kind);
    for (std::size_t size = 0; size < 24; ++size) {
      CAPTURE(size);
      CHECK_FALSE(decode_message(sender, kind, Bytes(size, std::uint8_t{0}), kMessageEdge));
      CHECK_FALSE(decode_message(sender, kind, Bytes(size, std::uint8_t{0xff}), kMessageEdge));
    }
  }
  Bytes ping = *encode_message(Ping{5}).bytes;
  ping.resize(kClientControlBytesMax);
  CHECK(decode_message(Sender::client, kKindOf<Ping>, ping, kMessageEdge).has_value());
  ping.push_back(0);
  CHECK_FALSE(decode_message(Sender::client, kKindOf<Ping>, ping, kMessageEdge).has_value());
}

TEST_CASE("the limit of a message is that of its sender", "[protocol]") {
  // Both sides send Goodbye.
  Bytes goodbye = *encode_message(Goodbye{GoodbyeReason::closing, "bye"}).bytes;
  goodbye.resize(kClientControlBytesMax + 1);
  const auto passes_from = [&goodbye](Sender sender) {
    return decode_message(sender, kKindOf<Goodbye>, goodbye, kMessageEdge).has_value();
  };
  CHECK_FALSE(passes_from(Sender::client));
  CHECK(passes_from(Sender::server));
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
