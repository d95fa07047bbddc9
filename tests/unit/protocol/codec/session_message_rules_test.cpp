#include "tests/unit/protocol/codec/built_message.hpp"

#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace runstone::test {
namespace {

struct HelloFields {
  std::uint32_t protocol = kProtocolVersion;
  std::size_t key = 32, nonce = 32;
  std::string name = "ann";
  std::uint8_t encodings = 3;
  std::uint64_t features = 0;
  Offset<wire::Hello> operator()(FlatBufferBuilder& b) const {
    const auto k = filled(b, key), n = filled(b, nonce);
    return wire::CreateHello(b, protocol, k, 1, n, b.CreateString(name), encodings, features);
  }
};

struct WelcomeFields {
  std::size_t world_id = 16, server_key = 32, challenge = 32, signature = 64;
  std::uint32_t epoch = 1;
  std::uint64_t durable = 4, head = 5;
  std::uint16_t edge = 32;
  std::int32_t y_min = -10, y_max = 10;
  WorldPos spawn;
  std::uint8_t encoding = 1, view_radius = 8, tile_levels = 8;
  std::uint64_t edits_per_second = 100, edit_burst = 4'000;
  struct Row {
    std::string name;
    std::uint32_t rgba;
    std::uint8_t visibility;
    std::uint8_t body = 0;
    std::optional<wire::MaterialLook> look = std::nullopt;
  };
  std::vector<Row> rows = {{"air", 0, 0}, {"stone", 0xff808080, 1}};
  bool has_spawn = true;
  Offset<wire::Welcome> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::MaterialRow>> table;
    for (const Row& row : rows) {
      table.push_back(wire::CreateMaterialRow(b, b.CreateString(row.name), row.rgba, row.visibility,
                                              row.body, row.look ? &*row.look : nullptr));
    }
    const auto materials = b.CreateVector(table);
    const auto w = filled(b, world_id), k = filled(b, server_key), c = filled(b, challenge),
               s = filled(b, signature);
    const wire::Position at(spawn.x, spawn.y, spawn.z);
    return wire::CreateWelcome(b, kProtocolVersion, w, epoch, durable, head, edge, y_min, y_max,
                               has_spawn ? &at : nullptr, materials, k, c, s, encoding, 1000,
                               edits_per_second, edit_burst, view_radius, 0, 0, tile_levels);
  }
};

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST_CASE("hello is refused with a field of the wrong size or range", "[protocol]") {
  refuses<Hello, HelloFields>({[](auto& h) { h.key = 31; }, [](auto& h) { h.key = 33; },
                               [](auto& h) { h.nonce = 0; }, [](auto& h) { h.name = ""; },
                               [](auto& h) { h.name = std::string(33, 'a'); },
                               [](auto& h) { h.name = "a\nb"; }, [](auto& h) { h.name = "\xc3"; },
                               [](auto& h) { h.name = "\x1b[2J"; },
                               [](auto& h) { h.encodings = 0; }, [](auto& h) { h.encodings = 8; }});
  HelloFields future;
  future.encodings = 1 + 128;  // an unknown encoding
  future.features = ~0ULL;     // unknown features
  const auto hello = received<Hello>(future);
  REQUIRE(hello.has_value());
  CHECK(std::get<Hello>(*hello).features == ~0ULL);  // unchanged: the transcript needs them
}

TEST_CASE("a hello of another protocol decodes to its version alone, so that it can be answered",
          "[protocol]") {
  HelloFields other;
  other.protocol = kProtocolVersion + 1;
  other.key = 48;
  other.name = "";
  const auto hello = received<Hello>(other);
  REQUIRE(hello.has_value());
  Hello expected;
  expected.protocol = kProtocolVersion + 1;
  CHECK(*hello == Message(expected));
}

TEST_CASE("welcome is refused with a field of the wrong size or range", "[protocol]") {
  refuses<Welcome, WelcomeFields>({[](auto& w) { w.world_id = 15; },
                                   [](auto& w) { w.server_key = 33; },
                                   [](auto& w) { w.challenge = 0; },
                                   [](auto& w) { w.signature = 63; },
                                   [](auto& w) { w.epoch = 0; },
                                   [](auto& w) { w.durable = 6; },
                                   [](auto& w) { w.edge = 0; },
                                   [](auto& w) { w.edge = 48; },
                                   [](auto& w) { w.edge = 256; },
                                   [](auto& w) { w.y_min = 11; },
                                   [](auto& w) { w.y_min = w.y_max; },
                                   [](auto& w) { w.y_min = -kWorldLimit - 1; },
                                   [](auto& w) { w.y_max = kWorldLimit + 1; },
                                   [](auto& w) { w.spawn.y = kNan; },
                                   [](auto& w) { w.spawn.x = -kInfinity; },
                                   [](auto& w) { w.spawn.z = kWorldLimit + 1.0; },
                                   [](auto& w) { w.has_spawn = false; },
                                   [](auto& w) { w.encoding = 0; },
                                   [](auto& w) { w.encoding = 4; },
                                   [](auto& w) { w.view_radius = 65; },
                                   [](auto& w) { w.tile_levels = 9; },
                                   [](auto& w) { w.edits_per_second = 0; },
                                   [](auto& w) { w.edit_burst = 0; },
                                   [](auto& w) { w.rows.clear(); },
                                   [](auto& w) { w.rows[0].name = "void"; },
                                   [](auto& w) { w.rows[0].visibility = 1; },
                                   [](auto& w) { w.rows[0].rgba = 1; },
                                   [](auto& w) { w.rows[1].name = "air"; },
                                   [](auto& w) { w.rows[1].name = ""; },
                                   [](auto& w) { w.rows[1].name = std::string(65, 'a'); },
                                   [](auto& w) { w.rows[1].name = "\xff"; },
                                   [](auto& w) { w.rows[1].visibility = 3; },
                                   [](auto& w) { w.rows[1].body = 3; },
                                   [](auto& w) { w.rows[1].rgba = 0x7f000000; }});
}

TEST_CASE("no look of a material refuses welcome", "[protocol]") {
  WelcomeFields silly;
  for (WelcomeFields::Row& row : silly.rows) row.look = wire::MaterialLook(255, 255, 255, 255, 255);
  const auto message = received<Welcome>(silly);
  REQUIRE(message.has_value());
  const MaterialTable& table = std::get<Welcome>(*message).materials;
  CHECK_FALSE(table[kEmpty].look.has_value());
  CHECK(table[1].look == MaterialLook{100, 100, 100, 100, MaterialPattern::none});
}

TEST_CASE("a table of all 65,536 materials with looks fits welcome", "[protocol]") {
  Welcome welcome;
  welcome.epoch = 1;
  for (unsigned i = 1; i < kMaterialCountMax; ++i) {
    const std::string digits = std::to_string(i);
    REQUIRE(welcome.materials.add({std::string(kMaterialNameBytesMax - digits.size(), 'm') + digits,
                                   {1, 2, 3, 255},
                                   Visibility::opaque,
                                   std::nullopt,
                                   MaterialBody::solid,
                                   MaterialLook{1, 2, 3, 4, MaterialPattern::cobble}}));
  }
  const EncodedMessage encoded = encode_message(welcome);
  CHECK(encoded.bytes->size() <= kServerControlBytesMax);
  const auto decoded = decode(encoded);
  REQUIRE(decoded.has_value());
  CHECK(std::get<Welcome>(*decoded).materials == welcome.materials);
}

TEST_CASE("the longest player list and the longest list of poses fit their class", "[protocol]") {
  PlayerList list;
  PlayerPoses poses;
  for (unsigned i = 0; i < kPlayersMax; ++i) {
    list.players.push_back({i, std::string(kPlayerNameBytesMax, 'n'), {}});
    poses.players.push_back({i, {}});
  }
  for (const Message& message : {Message(list), Message(poses)}) {
    const auto decoded = decode(encode_message(message));
    REQUIRE(decoded.has_value());
    CHECK(*decoded == message);
  }
}

TEST_CASE("signatures, views and poses are refused outside their bounds", "[protocol]") {
  CHECK(passes<ClientAuth>([](auto& b) { return wire::CreateClientAuth(b, filled(b, 64)); }));
  CHECK_FALSE(passes<ClientAuth>([](auto& b) { return wire::CreateClientAuth(b, filled(b, 65)); }));
  CHECK_FALSE(passes<ClientAuth>([](auto& b) { return wire::CreateClientAuth(b); }));

  const auto view = [](std::int32_t x, std::uint8_t h, std::uint8_t v, std::uint32_t number = 1) {
    return passes<View>([=](auto& b) { return wire::CreateView(b, number, x, 0, 0, h, v); });
  };
  CHECK(view(-kReach, 64, 64));
  CHECK(view(kReach - 1, 0, 0, 0xffff'ffff));
  CHECK_FALSE(view(0, 1, 1, 0));
  CHECK_FALSE(view(kReach, 1, 1));
  CHECK_FALSE(view(-kReach - 1, 1, 1));
  CHECK_FALSE(view(0, 65, 1));
  CHECK_FALSE(view(0, 1, 65));

  const auto look = [](std::uint16_t cone) {
    return passes<View>(
        [=](auto& b) { return wire::CreateView(b, 1, 0, 0, 0, 1, 1, 65'535, -32'768, cone); });
  };
  CHECK(look(0));
  CHECK(look(kViewConeMax));
  CHECK_FALSE(look(kViewConeMax + 1));

  const auto move = [](double x, double y, double z) {
    return passes<Move>([=](auto& b) {
      const wire::Pose pose(wire::Position(x, y, z), 1, 2);
      return wire::CreateMove(b, &pose);
    });
  };
  CHECK(move(kWorldLimit, -kWorldLimit, 0));
  CHECK_FALSE(move(kNan, 0, 0));
  CHECK_FALSE(move(0, kInfinity, 0));
  CHECK_FALSE(move(0, 0, -1e10));
  CHECK_FALSE(passes<Move>([](auto& b) { return wire::CreateMove(b); }));
}

TEST_CASE("a receive ack counts at least one byte", "[protocol]") {
  CHECK(passes<ReceiveAck>([](auto& b) { return wire::CreateReceiveAck(b, 1); }));
  CHECK(passes<ReceiveAck>([](auto& b) { return wire::CreateReceiveAck(b, ~0ULL); }));
  CHECK_FALSE(passes<ReceiveAck>([](auto& b) { return wire::CreateReceiveAck(b, 0); }));
}

TEST_CASE("commands and their output are refused unless they are bounded lines of text",
          "[protocol]") {
  const auto request = [](const std::string& text) {
    return passes<CommandRequest>(
        [&](auto& b) { return wire::CreateCommandRequest(b, 7, b.CreateString(text)); });
  };
  CHECK(request("undo"));
  CHECK(request(std::string(kCommandBytesMax, 'a')));
  CHECK_FALSE(request(std::string(kCommandBytesMax + 1, 'a')));
  CHECK_FALSE(request(""));
  CHECK_FALSE(request("undo\n"));
  CHECK_FALSE(passes<CommandRequest>([](auto& b) { return wire::CreateCommandRequest(b, 7); }));
  const auto output = [](std::size_t count, const std::string& line) {
    return passes<CommandOutput>([&](auto& b) {
      const std::vector<flatbuffers::Offset<flatbuffers::String>> lines(count,
                                                                        b.CreateString(line));
      return wire::CreateCommandOutput(b, 7, b.CreateVector(lines), true, true);
    });
  };
  CHECK(output(0, ""));
  CHECK(output(kCommandLinesMax, std::string(kCommandLineBytesMax, 'a')));
  CHECK_FALSE(output(kCommandLinesMax + 1, "a"));
  CHECK_FALSE(output(1, std::string(kCommandLineBytesMax + 1, 'a')));
  CHECK_FALSE(output(1, "a\nb"));
  CHECK(passes<CommandOutput>(
      [](auto& b) { return wire::CreateCommandOutput(b, 7); }));  // absent lines are no lines
  // The encoder makes its lines valid.
  const auto sent = encode_message(
      CommandOutput{7, {"a\tb\xff", std::string(2 * kCommandLineBytesMax, 'a')}, true, true});
  const auto read = decode(sent);
  REQUIRE(read.has_value());
  CHECK(std::get<CommandOutput>(*read).lines ==
        std::vector<std::string>{"a?b?", std::string(kCommandLineBytesMax, 'a')});
}

TEST_CASE("times are refused if their differences could overflow", "[protocol]") {
  const auto pong = [](TimeUs sent, TimeUs server) {
    return passes<Pong>([&](auto& b) { return wire::CreatePong(b, sent, server); });
  };
  CHECK(pong(kWireTimeUsMax, -kWireTimeUsMax));
  CHECK_FALSE(pong(kWireTimeUsMax + 1, 0));
  CHECK_FALSE(pong(0, -kWireTimeUsMax - 1));
  CHECK_FALSE(pong(0, INT64_MIN));
}

}  // namespace runstone::test
