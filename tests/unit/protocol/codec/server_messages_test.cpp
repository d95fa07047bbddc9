// Which values are refused of messages between servers, and that they come back unchanged.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

EditRecord record_at(Version version) {
  EditRecord record;
  record.version = version;
  record.op = {7, 0x0123456789abcdefULL, version.seq};
  record.time_us = 1'700'000'000'000'000;
  record.edit = {SetVoxel{{1, -2, 3}}, {}, 4};
  return record;
}

struct RecordFields {
  Bytes bytes;
  std::int64_t submitted_us = 0;
};
RecordFields fields_at(Epoch epoch, Sequence seq) {
  return {encode_record(record_at({epoch, seq}))};
}

struct PlayerFields {
  std::uint32_t author = 7;
  std::size_t key = 32;
  std::string name = "ann";
};
struct NameFields {
  std::string folded = "ann", name = "Ann";
  std::size_t key = 32;
};

struct LogPartFields {
  std::uint32_t epoch = 3;
  std::vector<PlayerFields> players = {{}};
  std::vector<NameFields> names = {{}};
  std::vector<RecordFields> records = {fields_at(2, 8), fields_at(3, 9)};
  Offset<wire::LogPart> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::LogPlayer>> player_rows;
    for (const PlayerFields& p : players) {
      const auto k = filled(b, p.key);
      player_rows.push_back(wire::CreateLogPlayer(b, p.author, k, b.CreateString(p.name)));
    }
    std::vector<Offset<wire::LogName>> name_rows;
    for (const NameFields& n : names) {
      const auto folded = b.CreateString(n.folded);
      const auto name = b.CreateString(n.name);
      name_rows.push_back(wire::CreateLogName(b, folded, name, filled(b, n.key), true));
    }
    std::vector<Offset<wire::LogRecordBytes>> record_rows;
    for (const RecordFields& r : records)
      record_rows.push_back(wire::CreateLogRecordBytes(b, b.CreateVector(r.bytes), r.submitted_us));
    const auto players_at = b.CreateVector(player_rows);
    const auto names_at = b.CreateVector(name_rows);
    return wire::CreateLogPart(b, epoch, players_at, names_at, b.CreateVector(record_rows));
  }
};

struct RelayOpenFields {
  std::size_t key = 32;
  std::string name = "ann";
  std::optional<wire::Pose> pose = wire::Pose(wire::Position(0.5, 70, -0.25), 16'384, -4'096);
  std::optional<std::string> ticket;
  std::optional<std::size_t> password_key;
  Offset<wire::RelayOpen> operator()(FlatBufferBuilder& b) const {
    const auto k = filled(b, key);
    const auto n = b.CreateString(name);
    const auto t = ticket ? b.CreateString(*ticket) : Offset<flatbuffers::String>();
    const auto p = password_key ? filled(b, *password_key) : Vector();
    return wire::CreateRelayOpen(b, 5, 1, true, k, 2, n, 3, 4, pose ? &*pose : nullptr, t, p);
  }
};

struct RelayFields {
  std::size_t sessions = 1;
  std::uint8_t kind = wire_number(kKindOf<ChatRequest>);
  std::size_t body = 9;
  Offset<wire::Relay> operator()(FlatBufferBuilder& b) const {
    const auto s = b.CreateVector(std::vector<std::uint32_t>(sessions, 5));
    return wire::CreateRelay(b, s, kind, filled(b, body));
  }
};

struct RelayCloseFields {
  std::uint8_t reason = 1;
  std::string text = "bye";
  Offset<wire::RelayClose> operator()(FlatBufferBuilder& b) const {
    return wire::CreateRelayClose(b, 5, reason, b.CreateString(text));
  }
};

bool comes_back(const Message& message) {
  const auto decoded = decode(encode_message(message));
  return decoded.has_value() && *decoded == message;
}

/// Returns a body of this size. What it holds is not verified.
EncodedMessage body_of(MessageKind kind, std::size_t size) {
  return {kind, std::make_shared<const Bytes>(size, std::uint8_t{7})};
}

}  // namespace

TEST_CASE("a request to follow and its answer are refused with a sequence of 64 bits",
          "[protocol]") {
  const auto request = [](Sequence seq) {
    return passes<FollowRequest>([&](auto& b) { return wire::CreateFollowRequest(b, 3, seq); });
  };
  CHECK(request(0));
  CHECK(request(kSequenceMax));
  CHECK_FALSE(request(kSequenceMax + 1));
  const auto answer = [](Sequence head) {
    return passes<FollowAnswer>([&](auto& b) { return wire::CreateFollowAnswer(b, head); });
  };
  CHECK(answer(0));
  CHECK(answer(kSequenceMax));
  CHECK_FALSE(answer(kSequenceMax + 1));
}

TEST_CASE("a request to follow is refused with an address of a wrong form", "[protocol]") {
  const auto request = [](const std::string& address, const std::string& page) {
    return passes<FollowRequest>([&](auto& b) {
      const auto address_at = b.CreateString(address);
      return wire::CreateFollowRequest(b, 3, 4, address_at, b.CreateString(page));
    });
  };
  CHECK(request("", ""));
  CHECK(request("play.example:4747", "https://play.example"));
  CHECK_FALSE(request("play.example", ""));
  CHECK_FALSE(request("play.example:0", ""));
  CHECK_FALSE(request(std::string(kServerAddressBytesMax - 1, 'a') + ":1", ""));
  CHECK_FALSE(request("", "play.example"));
  CHECK_FALSE(request("", "https://" + std::string(kServerAddressBytesMax, 'a')));
  CHECK(comes_back(FollowRequest{{3, 4}, "play.example:4747", "https://play.example"}));
}

TEST_CASE("a part of the log is refused with a bad player or name", "[protocol]") {
  refuses<LogPart, LogPartFields>({
      [](auto& p) { p.players[0].author = 0; },
      [](auto& p) { p.players[0].key = 31; },
      [](auto& p) { p.players[0].key = 33; },
      [](auto& p) { p.players[0].name = ""; },
      [](auto& p) { p.players[0].name = std::string(kPlayerNameBytesMax + 1, 'a'); },
      [](auto& p) { p.players[0].name = "a\nb"; },
      [](auto& p) { p.players.resize(kLogPartRowsMax + 1); },
      [](auto& p) { p.names[0].folded = ""; },
      [](auto& p) { p.names[0].folded = std::string(kFoldedNameBytesMax + 1, 'a'); },
      [](auto& p) { p.names[0].folded = "a\nb"; },
      [](auto& p) { p.names[0].name = ""; },
      [](auto& p) { p.names[0].name = std::string(kPlayerNameBytesMax + 1, 'a'); },
      [](auto& p) { p.names[0].name = "a\nb"; },
      [](auto& p) { p.names[0].key = 31; },
      [](auto& p) { p.names.resize(kLogPartRowsMax + 1); },
  });
  LogPartFields longest;
  longest.players[0].name = std::string(kPlayerNameBytesMax, 'a');
  longest.names[0] = {std::string(kFoldedNameBytesMax, 'a'), std::string(kPlayerNameBytesMax, 'a')};
  CHECK(passes<LogPart>(longest));
  LogPartFields most;
  most.players.resize(kLogPartRowsMax);
  CHECK(passes<LogPart>(most));
  most.names.resize(kLogPartRowsMax);
  most.players.clear();
  CHECK(passes<LogPart>(most));
}

TEST_CASE("a part of the log is refused with a bad record", "[protocol]") {
  refuses<LogPart, LogPartFields>({
      [](auto& p) { p.records[0].bytes.clear(); },
      [](auto& p) { p.records[0].bytes.pop_back(); },
      [](auto& p) { p.records[0].bytes.push_back(0); },
      [](auto& p) { p.records[0].bytes[0] = kEditRecordVersion + 1; },
      [](auto& p) { p.records[1].submitted_us = kWireTimeUsMax + 1; },
      [](auto& p) { p.records[1].submitted_us = -kWireTimeUsMax - 1; },
  });
  LogPartFields latest;
  latest.records[1].submitted_us = kWireTimeUsMax;
  CHECK(passes<LogPart>(latest));
}

TEST_CASE("a part of the log is refused if its epochs fall or its records have a gap",
          "[protocol]") {
  refuses<LogPart, LogPartFields>({
      [](auto& p) { p.epoch = 0, p.records.clear(); },
      [](auto& p) { p.epoch = 2; },  // the last record is of epoch 3
      [](auto& p) { p.records[0] = fields_at(4, 8); },
      [](auto& p) { p.records[1] = fields_at(1, 9); },
      [](auto& p) { p.records[1] = fields_at(3, 8); },
      [](auto& p) { p.records[1] = fields_at(3, 10); },
      [](auto& p) { std::swap(p.records[0], p.records[1]); },
      [](auto& p) {
        p.records.clear();
        for (Sequence seq = 1; seq <= kLogPartRecordsMax + 1; ++seq)
          p.records.push_back(fields_at(3, seq));
      },
  });
  CHECK(passes<LogPart>([](auto& b) { return wire::CreateLogPart(b, 1); }));
  LogPartFields most;
  most.records.clear();
  for (Sequence seq = 1; seq <= kLogPartRecordsMax; ++seq)
    most.records.push_back(fields_at(3, seq));
  CHECK(passes<LogPart>(most));
}

TEST_CASE("a player's session is refused without a key, a name and a pose, or with a bad secret",
          "[protocol]") {
  refuses<RelayOpen, RelayOpenFields>({
      [](auto& r) { r.key = 31; },
      [](auto& r) { r.key = 33; },
      [](auto& r) { r.name = ""; },
      [](auto& r) { r.name = std::string(kPlayerNameBytesMax + 1, 'a'); },
      [](auto& r) { r.name = "a\nb"; },
      [](auto& r) { r.pose = std::nullopt; },
      [](auto& r) { r.pose = wire::Pose(wire::Position(0, kWorldLimit + 1.0, 0), 0, 0); },
      [](auto& r) { r.ticket = ""; },
      [](auto& r) { r.ticket = std::string(kTicketBytesMax + 1, 'a'); },
      [](auto& r) { r.ticket = "a\nb"; },
      [](auto& r) { r.password_key = 0; },
      [](auto& r) { r.password_key = kPasswordKeyBytes - 1; },
      [](auto& r) { r.password_key = kPasswordKeyBytes + 1; },
  });
  RelayOpenFields full;
  full.ticket = std::string(kTicketBytesMax, 'a');
  full.password_key = kPasswordKeyBytes;
  CHECK(passes<RelayOpen>(full));
}

TEST_CASE("a relayed message is refused for no session, for too many, and of an unknown kind",
          "[protocol]") {
  refuses<Relay, RelayFields>({
      [](auto& r) { r.sessions = 0; },
      [](auto& r) { r.sessions = kRelaySessionsMax + 1; },
      [](auto& r) { r.kind = 0; },
      [](auto& r) { r.kind = kMessageKindCount + 1; },
      [](auto& r) { r.body = kClientEditBytesMax; },
  });
  CHECK(passes<Relay>(RelayFields{kRelaySessionsMax, kMessageKindCount, 0}));
  CHECK_FALSE(passes<Relay>([](auto& b) { return wire::CreateRelay(b, 0, 1); }));
  // The body is not verified.
  const auto message = received<Relay>(RelayFields{});
  REQUIRE(message.has_value());
  CHECK(*message == Message(Relay{{5}, body_of(kKindOf<ChatRequest>, 9)}));
  CHECK_FALSE(*message == Message(Relay{{6}, body_of(kKindOf<ChatRequest>, 9)}));
  CHECK_FALSE(*message == Message(Relay{{5}, body_of(kKindOf<CommandRequest>, 9)}));
  CHECK_FALSE(*message == Message(Relay{{5}, body_of(kKindOf<ChatRequest>, 8)}));
}

TEST_CASE("the end of a relayed session is refused with a bad reason or text", "[protocol]") {
  refuses<RelayClose, RelayCloseFields>({
      [](auto& r) { r.reason = 0; },
      [](auto& r) { r.reason = kGoodbyeReasonMax + 1; },
      [](auto& r) { r.text = std::string(kTextBytesMax + 1, 'a'); },
      [](auto& r) { r.text = "\t"; },
  });
  CHECK(passes<RelayClose>(RelayCloseFields{kGoodbyeReasonMax, std::string(kTextBytesMax, 'a')}));
  CHECK(passes<RelayClose>([](auto& b) { return wire::CreateRelayClose(b, 5, 1); }));
}

TEST_CASE("messages between servers come back unchanged", "[protocol]") {
  PublicKey key{};
  key.fill(9);
  CHECK(comes_back(FollowRequest{}));
  CHECK(comes_back(FollowRequest{{3, kSequenceMax}}));
  CHECK(comes_back(FollowAnswer{kSequenceMax}));
  CHECK(comes_back(LogPart{}));
  CHECK(comes_back(LogPart{3,
                           {{7, key, "ann"}, {8, {}, "bob"}},
                           {{"ann", "Ann", key, false}, {"bob", "Bob", key, true}},
                           {{record_at({2, 8}), 5}, {record_at({3, 9}), 0}}}));
  RelayOpen open;
  open.name = "ann";
  CHECK(comes_back(open));
  const Pose pose{{0.5, 70, -0.25}, 16'384, -4'096};
  open = {5,     ~0ULL,          true, key,  2,
          "ann", kFeaturesKnown, 7,    pose, std::string(kTicketBytesMax, 't')};
  CHECK(comes_back(open));
  open.password_key = key;
  CHECK(comes_back(open));
  CHECK(comes_back(Relay{{5}, encode_message(ChatRequest{"hello"})}));
  CHECK(comes_back(Relay{{5, 3, 5}, body_of(kMessageKindCount - 1, 0)}));
  CHECK(comes_back(RelayClose{5, kGoodbyeReasonMax, "bye"}));
  CHECK(comes_back(RelayCharge{}));
  CHECK(comes_back(RelayCharge{5, ~0ULL}));
}

TEST_CASE("the largest relayed messages fit the limits of both sides", "[protocol]") {
  FlatBufferBuilder b;
  const Vector descriptor = filled(b, kDescriptorBytesMax);
  b.Finish(wire::CreateEditRequest(b, kSequenceMax, kWireTimeUsMax, descriptor, kSequenceMax));
  const EncodedMessage of_follower =
      encode_message(Relay{{~SessionId{0}}, body_of(kKindOf<EditRequest>, b.GetSize())});
  CHECK(of_follower.bytes->size() <= kClientEditBytesMax);
  CHECK(decode_message(Sender::client, of_follower.kind, *of_follower.bytes, 0).has_value());

  const EncodedMessage of_owner =
      encode_message(Relay{std::vector<SessionId>(kRelaySessionsMax, 5),
                           body_of(kKindOf<PlayerList>, kRelayBodyBytesMax)});
  CHECK(of_owner.bytes->size() <= kServerEditBytesMax);
  CHECK(decode_message(Sender::server, of_owner.kind, *of_owner.bytes, 0).has_value());
  CHECK_FALSE(decode_message(Sender::client, of_owner.kind, *of_owner.bytes, 0).has_value());
}

}  // namespace runstone::test
