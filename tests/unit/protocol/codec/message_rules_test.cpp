// Messages that verify as FlatBuffers and break a rule of their own, built field by field.
#include <flatbuffers/flatbuffers.h>
#include <catch2/catch.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <limits>
#include <set>

#include "protocol/codec/messages.hpp"
#include "protocol/schema/runstone_generated.h"
#include "tests/support/random_message.hpp"

namespace runstone::test {
namespace {

using flatbuffers::FlatBufferBuilder;
using flatbuffers::Offset;
using Vector = Offset<flatbuffers::Vector<std::uint8_t>>;

template <class Table>
Bytes message_of(FlatBufferBuilder& b, Offset<Table> body, const char* identifier = "RUN1") {
  b.Finish(wire::CreateMessage(b, wire::BodyTraits<Table>::enum_value, body.Union()), identifier);
  return {b.GetBufferPointer(), b.GetBufferPointer() + b.GetSize()};
}

Vector filled(FlatBufferBuilder& b, std::size_t size) {
  return b.CreateVector(Bytes(size, std::uint8_t{7}));
}

/// What one side makes of a body built by `build`; the class is the body's own.
template <class Build>
Result<Message> received(Sender sender, FrameClass frame_class, Build&& build,
                         std::uint16_t edge = kMessageEdge) {
  FlatBufferBuilder b;
  const Bytes bytes = message_of(b, build(b));
  return decode_message(sender, frame_class, bytes, edge);
}

template <class Build>
bool passes_from_client(Build&& build, FrameClass frame_class = FrameClass::control) {
  return received(Sender::client, frame_class, build).has_value();
}
template <class Build>
bool passes_from_server(Build&& build, FrameClass frame_class = FrameClass::control) {
  return received(Sender::server, frame_class, build).has_value();
}

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
  std::uint8_t encoding = 1, view_radius = 8;
  struct Row {
    std::string name;
    std::uint32_t rgba;
    std::uint8_t visibility;
  };
  std::vector<Row> rows = {{"air", 0, 0}, {"stone", 0xff808080, 1}};
  bool has_spawn = true;
  Offset<wire::Welcome> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::MaterialRow>> table;
    for (const Row& row : rows) {
      table.push_back(
          wire::CreateMaterialRow(b, b.CreateString(row.name), row.rgba, row.visibility));
    }
    const auto materials = b.CreateVector(table);
    const auto w = filled(b, world_id), k = filled(b, server_key), c = filled(b, challenge),
               s = filled(b, signature);
    const wire::Position at(spawn.x, spawn.y, spawn.z);
    return wire::CreateWelcome(b, kProtocolVersion, w, epoch, durable, head, edge, y_min, y_max,
                               has_spawn ? &at : nullptr, materials, k, c, s, encoding, 1000,
                               view_radius);
  }
};

const EditDescriptor kEdit{SetVoxel{{1, 2, 3}}, {}, 1};

struct CommitFields {
  std::uint32_t epoch = 1;
  std::uint64_t first = 10;
  std::uint8_t cause = 0;
  Bytes edit = encode(kEdit);
  Bytes previous{1};
  std::size_t edits = 1;
  std::uint64_t subject = 0;
  bool shared = false;  // all edits point at one list
  Offset<wire::Commit> operator()(FlatBufferBuilder& b) const {
    std::vector<Offset<wire::OrderedEdit>> list;
    Vector list_of_all;
    if (shared) list_of_all = b.CreateVector(previous);
    for (std::size_t i = 0; i < edits; ++i) {
      const auto e = b.CreateVector(edit);
      const auto p = shared ? list_of_all : b.CreateVector(previous);
      list.push_back(wire::CreateOrderedEdit(b, 1, 1, 1, cause, 0, 0, e, p, subject));
    }
    return wire::CreateCommit(b, epoch, first, b.CreateVector(list));
  }
};

struct ChunkFields {
  wire::Key key{0, 1, 2, 3};
  wire::Version version{1, 1};
  wire::Digest digest{5, 6};
  Bytes data = encode_chunk(uniform_chunk(Extent::cube(kMessageEdge), 1), ChunkEncoding::raw);
  bool has_key = true, has_version = true, has_digest = true;
  Offset<wire::Chunk> operator()(FlatBufferBuilder& b) const {
    const auto d = b.CreateVector(data);
    return wire::CreateChunk(b, has_key ? &key : nullptr, has_version ? &version : nullptr,
                             has_digest ? &digest : nullptr, d);
  }
};

/// `fields` as they are pass; with `bend` they do not.
template <class Fields>
void refuses(Sender sender, FrameClass frame_class,
             const std::vector<std::function<void(Fields&)>>& bends) {
  REQUIRE(received(sender, frame_class, Fields{}).has_value());
  for (std::size_t i = 0; i < bends.size(); ++i) {
    CAPTURE(i);
    Fields fields;
    bends[i](fields);
    CHECK_FALSE(received(sender, frame_class, fields).has_value());
  }
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kReach = kWorldLimit / kMessageEdge;

}  // namespace

TEST_CASE("hello is refused with a field of the wrong size or range", "[protocol]") {
  refuses<HelloFields>(
      Sender::client, FrameClass::control,
      {[](auto& h) { h.key = 31; }, [](auto& h) { h.key = 33; }, [](auto& h) { h.nonce = 0; },
       [](auto& h) { h.name = ""; }, [](auto& h) { h.name = std::string(33, 'a'); },
       [](auto& h) { h.name = "a\nb"; }, [](auto& h) { h.name = "\xc3"; },
       [](auto& h) { h.name = "\x1b[2J"; }, [](auto& h) { h.encodings = 0; },
       [](auto& h) { h.encodings = 8; }});
  HelloFields future;
  future.encodings = 1 + 128;  // an encoding that does not exist yet
  future.features = ~0ULL;     // nor do these
  const auto hello = received(Sender::client, FrameClass::control, future);
  REQUIRE(hello.has_value());
  CHECK(std::get<Hello>(*hello).features == ~0ULL);  // as sent: the transcript needs them
}

TEST_CASE("hello of another protocol passes with its version alone, so that it can be answered",
          "[protocol]") {
  HelloFields other;
  other.protocol = 1;
  other.key = 48;
  other.name = "";
  const auto hello = received(Sender::client, FrameClass::control, other);
  REQUIRE(hello.has_value());
  Hello expected;
  expected.protocol = 1;
  CHECK(*hello == Message(expected));
}

TEST_CASE("welcome is refused with a field of the wrong size or range", "[protocol]") {
  refuses<WelcomeFields>(Sender::server, FrameClass::control,
                         {[](auto& w) { w.world_id = 15; },
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
                          [](auto& w) { w.rows.clear(); },
                          [](auto& w) { w.rows[0].name = "void"; },
                          [](auto& w) { w.rows[0].visibility = 1; },
                          [](auto& w) { w.rows[0].rgba = 1; },
                          [](auto& w) { w.rows[1].name = "air"; },
                          [](auto& w) { w.rows[1].name = ""; },
                          [](auto& w) { w.rows[1].name = std::string(65, 'a'); },
                          [](auto& w) { w.rows[1].name = "\xff"; },
                          [](auto& w) { w.rows[1].visibility = 3; },
                          [](auto& w) { w.rows[1].rgba = 0x7f000000; }});
}

TEST_CASE("a table of all 65,536 materials fits welcome", "[protocol]") {
  Welcome welcome;
  welcome.epoch = 1;
  for (unsigned i = 1; i < kMaterialCountMax; ++i) {
    const std::string digits = std::to_string(i);
    REQUIRE(welcome.materials.add({std::string(kMaterialNameBytesMax - digits.size(), 'm') + digits,
                                   {1, 2, 3, 255},
                                   Visibility::opaque,
                                   std::nullopt}));
  }
  const EncodedMessage encoded = encode_message(welcome);
  CHECK(encoded.bytes->size() <= kServerControlBytesMax);
  const auto decoded = decode(welcome, encoded);
  REQUIRE(decoded.has_value());
  CHECK(std::get<Welcome>(*decoded).materials == welcome.materials);
}

TEST_CASE("the longest roster and the longest list of poses fit their class", "[protocol]") {
  PlayerList roster;
  PlayerPoses poses;
  for (unsigned i = 0; i < kPlayersMax; ++i) {
    roster.players.push_back({i, std::string(kPlayerNameBytesMax, 'n')});
    poses.players.push_back({i, {}});
  }
  for (const Message& message : {Message(roster), Message(poses)}) {
    const auto decoded = decode(message, encode_message(message));
    REQUIRE(decoded.has_value());
    CHECK(*decoded == message);
  }
}

TEST_CASE("signatures, views, keys and poses keep their bounds", "[protocol]") {
  CHECK(passes_from_client([](auto& b) { return wire::CreateClientAuth(b, filled(b, 64)); }));
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateClientAuth(b, filled(b, 65)); }));
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateClientAuth(b); }));

  const auto view = [](std::int32_t x, std::uint8_t h, std::uint8_t v) {
    return passes_from_client([=](auto& b) { return wire::CreateView(b, x, 0, 0, h, v); });
  };
  CHECK(view(-kReach, 64, 64));
  CHECK(view(kReach - 1, 0, 0));
  CHECK_FALSE(view(kReach, 1, 1));
  CHECK_FALSE(view(-kReach - 1, 1, 1));
  CHECK_FALSE(view(0, 65, 1));
  CHECK_FALSE(view(0, 1, 65));

  const auto look = [](std::uint16_t cone) {
    return passes_from_client(
        [=](auto& b) { return wire::CreateView(b, 0, 0, 0, 1, 1, 65'535, -32'768, cone); });
  };
  CHECK(look(0));
  CHECK(look(kViewConeMax));
  CHECK_FALSE(look(kViewConeMax + 1));

  const auto request = [](const std::vector<wire::Key>& keys) {
    return passes_from_client(
        [&](auto& b) { return wire::CreateChunkRequest(b, b.CreateVectorOfStructs(keys)); });
  };
  CHECK(request(std::vector<wire::Key>(64)));
  CHECK_FALSE(request(std::vector<wire::Key>(65)));
  CHECK_FALSE(request({}));
  CHECK_FALSE(request({wire::Key(0, 0, kReach, 0)}));
  CHECK_FALSE(request({wire::Key(1, 0, 0, 0)}));  // levels of detail are reserved
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateChunkRequest(b); }));

  const auto move = [](double x, double y, double z) {
    return passes_from_client([=](auto& b) {
      const wire::Pose pose(wire::Position(x, y, z), 1, 2);
      return wire::CreateMove(b, &pose);
    });
  };
  CHECK(move(kWorldLimit, -kWorldLimit, 0));
  CHECK_FALSE(move(kNan, 0, 0));
  CHECK_FALSE(move(0, kInfinity, 0));
  CHECK_FALSE(move(0, 0, -1e10));
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateMove(b); }));
}

TEST_CASE("a snapshot is refused with bad keys, versions, digests, bytes or size", "[protocol]") {
  refuses<ChunkFields>(
      Sender::server, FrameClass::chunks,
      {[](auto& c) { c.has_key = false; }, [](auto& c) { c.has_version = false; },
       [](auto& c) { c.has_digest = false; }, [](auto& c) { c.key = wire::Key(0, kReach, 0, 0); },
       [](auto& c) { c.key = wire::Key(1, 0, 0, 0); },
       [](auto& c) { c.version = wire::Version(0, 1); },
       [](auto& c) { c.version = wire::Version(1, 0); },
       [](auto& c) { c.digest = wire::Digest((1ULL << 61) - 1, 0); },
       [](auto& c) { c.digest = wire::Digest(0, ~0ULL); }, [](auto& c) { c.data.clear(); },
       [](auto& c) { c.data.pop_back(); }, [](auto& c) { c.data.push_back(0); },
       [](auto& c) {
         c.data = encode_chunk(uniform_chunk(Extent::cube(32), 1), ChunkEncoding::raw);
       }});
  ChunkFields base;
  base.version = wire::Version(0, 0);
  CHECK(passes_from_server(base, FrameClass::chunks));
  // Before welcome the size of chunks is not known.
  base.data = encode_chunk(uniform_chunk(Extent{8, 9, 10}, 1), ChunkEncoding::packed);
  CHECK(received(Sender::server, FrameClass::chunks, base, 0).has_value());
}

TEST_CASE("received counts from one on, and only clients say it", "[protocol]") {
  CHECK(passes_from_client([](auto& b) { return wire::CreateReceiveAck(b, 1); }));
  CHECK(passes_from_client([](auto& b) { return wire::CreateReceiveAck(b, ~0ULL); }));
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateReceiveAck(b, 0); }));
  CHECK_FALSE(passes_from_server([](auto& b) { return wire::CreateReceiveAck(b, 1); }));
}

TEST_CASE("uniform chunks ascend, lie inside the world and are not too many", "[protocol]") {
  const auto read = [](const Bytes& data) {
    return received(Sender::server, FrameClass::chunks, [&](auto& b) {
      return wire::CreateUniformChunks(b, b.CreateVector(data.data(), data.size()));
    });
  };
  const auto entry = [](std::int64_t x, std::int64_t z, std::int64_t y, std::uint64_t more,
                        std::uint64_t material = 1, std::uint64_t epoch = 0) {
    Bytes out;
    ByteWriter w(out);
    w.svarint(x);
    w.svarint(z);
    w.svarint(y);
    w.varint(more);
    w.varint(material);
    w.varint(epoch);
    return out;
  };
  const auto joined = [](Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  const auto whole = read(entry(0, 0, -5, 4'095));
  REQUIRE(whole.has_value());
  CHECK(std::get<UniformChunks>(*whole).chunks.size() == 4'096);
  CHECK(std::get<UniformChunks>(*whole).chunks.back() == UniformChunk{{0, {0, 4'090, 0}}, 1, {}});
  CHECK_FALSE(read({}).has_value());
  CHECK_FALSE(read(entry(0, 0, 0, 4'096)).has_value());
  CHECK_FALSE(
      read(joined(entry(0, 0, 0, 4'095), entry(1, 0, 0, 0))).has_value());  // too many in all
  CHECK_FALSE(
      read(joined(entry(0, 0, 0, 3), entry(0, 0, 3, 0))).has_value());  // the same chunk twice
  CHECK(read(joined(entry(0, 0, 0, 3), entry(0, 0, 4, 0))).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0), entry(0, -1, 0, 0))).has_value());  // goes back
  CHECK(read(joined(entry(0, 0, 0, 0), entry(1, -1, 0, 0))).has_value());
  CHECK(read(entry(kReach - 1, -kReach, kReach - 4, 3)).has_value());
  CHECK_FALSE(read(entry(kReach, 0, 0, 0)).has_value());
  CHECK_FALSE(read(entry(0, -kReach - 1, 0, 0)).has_value());
  CHECK_FALSE(read(entry(0, 0, kReach - 4, 4)).has_value());  // reaches out of the world at its top
  CHECK_FALSE(
      read(joined(entry(1, 0, 0, 0), entry(std::numeric_limits<std::int64_t>::max(), 0, 0, 0)))
          .has_value());
  CHECK_FALSE(read(entry(0, 0, 0, 0, 65'536)).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0, 1, 3), {0})).has_value());  // half a version
  CHECK(read(joined(entry(0, 0, 0, 0, 1, 3), {9})).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0, 1, 1ULL << 32), {9})).has_value());
  Bytes cut = entry(-300, 70'000, 9, 100, 300, 0);
  CHECK_FALSE(read(joined(cut, {0})).has_value());
  while (!cut.empty()) {
    cut.pop_back();
    CHECK_FALSE(read(cut).has_value());
  }
}

TEST_CASE("unavailable chunks are named, and their reason may be one of the future", "[protocol]") {
  const auto read = [](const std::vector<wire::Key>& keys, std::uint8_t reason) {
    return received(Sender::server, FrameClass::chunks, [&](auto& b) {
      return wire::CreateChunkUnavailable(b, b.CreateVectorOfStructs(keys), reason);
    });
  };
  const auto most = read(std::vector<wire::Key>(kUnavailableKeysMax), 255);
  REQUIRE(most.has_value());
  CHECK(std::get<ChunkUnavailable>(*most).keys.size() == kUnavailableKeysMax);
  CHECK(to_string(std::get<ChunkUnavailable>(*most).reason) == std::string("unknown"));
  CHECK_FALSE(read(std::vector<wire::Key>(kUnavailableKeysMax + 1), 1).has_value());
  CHECK_FALSE(read({}, 1).has_value());
  CHECK_FALSE(read({wire::Key(0, 1, 2, 3)}, 0).has_value());
  CHECK_FALSE(read({wire::Key(0, kReach, 0, 0)}, 1).has_value());
  CHECK_FALSE(read({wire::Key(1, 0, 0, 0)}, 1).has_value());
  CHECK_FALSE(passes_from_server([](auto& b) { return wire::CreateChunkUnavailable(b, 0, 1); },
                                 FrameClass::chunks));
  const std::vector<wire::Key> here(1);
  const auto build = [&](auto& b) {
    return wire::CreateChunkUnavailable(b, b.CreateVectorOfStructs(here), 1);
  };
  CHECK_FALSE(passes_from_server(build, FrameClass::control));
  CHECK_FALSE(passes_from_client(build, FrameClass::chunks));
}

TEST_CASE("lists of what is held are refused unless they are canonical and inside the world",
          "[protocol]") {
  const auto held = [](const Bytes& bytes, std::uint16_t edge = kMessageEdge) {
    return received(
               Sender::client, FrameClass::control,
               [&](FlatBufferBuilder& b) {
                 return wire::CreateCachedChunks(b, b.CreateVector(bytes));
               },
               edge)
        .has_value();
  };
  const auto bytes_of = [](std::vector<std::int64_t> key, std::vector<std::uint64_t> version,
                           std::uint64_t digest) {
    Bytes bytes;
    ByteWriter out(bytes);
    for (const std::int64_t c : key) out.svarint(c);
    for (const std::uint64_t v : version) out.varint(v);
    out.u64(digest);
    return bytes;
  };
  const auto joined = [](Bytes a, const Bytes& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  };
  CHECK(held(bytes_of({1, -2, 3}, {0}, 7)));
  CHECK(held(bytes_of({1, -2, 3}, {4, 500}, 7)));
  CHECK_FALSE(held({}));
  CHECK_FALSE(held(bytes_of({1, -2, 3}, {4, 0}, 7)));                          // half a version
  CHECK_FALSE(held(bytes_of({1, -2, 3}, {std::uint64_t{1} << 32, 500}, 7)));   // no epoch
  CHECK_FALSE(held(bytes_of({1, -2, 3}, {4, std::uint64_t{1} << 63}, 7)));     // no sequence
  CHECK_FALSE(held(bytes_of({1, -2, 3}, {0}, (std::uint64_t{1} << 61) - 1)));  // not reduced
  CHECK(held(bytes_of({kReach - 1, 0, -kReach}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({kReach, 0, 0}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({0, 0, -kReach - 1}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({std::int64_t{1} << 40, 0, 0}, {0}, 7)));
  const Bytes first = bytes_of({1, -2, 3}, {0}, 7);
  CHECK(held(joined(first, bytes_of({0, 0, 1}, {0}, 7))));
  CHECK_FALSE(held(joined(first, bytes_of({0, 0, 0}, {0}, 7))));   // twice
  CHECK_FALSE(held(joined(first, bytes_of({0, -1, 5}, {0}, 7))));  // back
  CHECK_FALSE(held(joined(first, {0})));
  Bytes many = first;
  for (std::size_t i = 1; i < kHeldChunksMax; ++i) many = joined(many, bytes_of({0, 0, 1}, {0}, 7));
  CHECK(held(many));
  CHECK_FALSE(held(joined(many, bytes_of({0, 0, 1}, {0}, 7))));
  CHECK_FALSE(received(Sender::server, FrameClass::control, [&](FlatBufferBuilder& b) {
                return wire::CreateCachedChunks(b, b.CreateVector(first));
              }).has_value());

  const auto same = [](const Bytes& bytes) {
    return passes_from_server(
        [&](FlatBufferBuilder& b) {
          return wire::CreateChunksNotModified(b, b.CreateVector(bytes));
        },
        FrameClass::chunks);
  };
  CHECK(same({2, 0, 0, 10}));                     // (1, 0, 0) at 5
  CHECK(same({2, 0, 0, 10, 0, 0, 2, 9}));         // (1, 0, 1) at 0
  CHECK_FALSE(same({2, 0, 0, 10, 0, 0, 2, 11}));  // at -1
  CHECK_FALSE(same({2, 0, 0, 1}));
  CHECK_FALSE(same({}));
  CHECK_FALSE(same({2, 0, 0}));
}

struct ChunkEditsFields {
  wire::Key key{0, 1, 2, 3};
  wire::Version to{2, 12};
  wire::Digest digest{5, 6};
  std::uint64_t from = 9;
  bool has_key = true, has_to = true, has_digest = true;
  std::vector<std::pair<std::uint64_t, Bytes>> edits = {{1, encode(kEdit)}, {2, encode(kEdit)}};
  Offset<wire::ChunkEdits> operator()(FlatBufferBuilder& b) const {
    Bytes bytes;
    ByteWriter out(bytes);
    for (const auto& [step, edit] : edits) {
      out.varint(step);
      out.varint(edit.size());
      out.bytes(edit);
    }
    return wire::CreateChunkEdits(b, has_key ? &key : nullptr, from, has_to ? &to : nullptr,
                                  has_digest ? &digest : nullptr, b.CreateVector(bytes));
  }
};

TEST_CASE("missing edits are refused where they do not lead from one version to the other",
          "[protocol]") {
  refuses<ChunkEditsFields>(
      Sender::server, FrameClass::chunks,
      {[](auto& f) { f.has_key = false; }, [](auto& f) { f.has_to = false; },
       [](auto& f) { f.has_digest = false; }, [](auto& f) { f.key = {1, 0, 0, 0}; },
       [](auto& f) { f.key = {0, kReach, 0, 0}; }, [](auto& f) { f.to = {2, 13}; },
       [](auto& f) { f.to = {0, 12}; }, [](auto& f) { f.from = 12; }, [](auto& f) { f.from = 13; },
       [](auto& f) { f.to = {2, std::uint64_t{1} << 63}; }, [](auto& f) { f.edits[1].first = 0; },
       [](auto& f) { f.edits[0].first = 2; }, [](auto& f) { f.edits.clear(); },
       [](auto& f) { f.edits[0].second.push_back(0); }, [](auto& f) { f.edits[0].second = {}; },
       [](auto& f) {
         f.edits.assign(kChunkEditsMax + 1, {1, encode(kEdit)});
         f.to = {2, f.from + kChunkEditsMax + 1};
       }});
}

TEST_CASE("commands and their output are bounded lines of text", "[protocol]") {
  const auto request = [](const std::string& text) {
    return passes_from_client(
        [&](auto& b) { return wire::CreateCommandRequest(b, 7, b.CreateString(text)); });
  };
  CHECK(request("undo"));
  CHECK(request(std::string(kCommandBytesMax, 'a')));
  CHECK_FALSE(request(std::string(kCommandBytesMax + 1, 'a')));
  CHECK_FALSE(request(""));
  CHECK_FALSE(request("undo\n"));
  CHECK_FALSE(passes_from_client([](auto& b) { return wire::CreateCommandRequest(b, 7); }));
  CHECK_FALSE(passes_from_server(
      [](auto& b) { return wire::CreateCommandRequest(b, 7, b.CreateString("undo")); }));
  const auto output = [](std::size_t count, const std::string& line) {
    return passes_from_server([&](auto& b) {
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
  CHECK(passes_from_server(
      [](auto& b) { return wire::CreateCommandOutput(b, 7); }));  // no lines are none
  // What a sender was given is made fit to be read.
  const auto sent = encode_message(
      CommandOutput{7, {"a\tb\xff", std::string(2 * kCommandLineBytesMax, 'a')}, true, true});
  const auto read = decode_message(Sender::server, FrameClass::control, *sent.bytes, 16);
  REQUIRE(read.has_value());
  CHECK(std::get<CommandOutput>(*read).lines ==
        std::vector<std::string>{"a?b?", std::string(kCommandLineBytesMax, 'a')});
}

TEST_CASE("an edit request needs a sequence and one whole descriptor", "[protocol]") {
  const auto request = [](std::uint64_t seq, const Bytes& edit) {
    return passes_from_client(
        [&](auto& b) { return wire::CreateEditRequest(b, seq, 0, b.CreateVector(edit)); },
        FrameClass::edits);
  };
  const Bytes edit = encode(kEdit);
  CHECK(request(1, edit));
  CHECK(request(kSequenceMax, edit));
  CHECK_FALSE(request(kSequenceMax + 1, edit));  // a store could not keep it
  CHECK_FALSE(request(0, edit));
  CHECK_FALSE(request(1, {}));
  CHECK_FALSE(request(1, Bytes(edit.begin(), edit.end() - 1)));
  Bytes longer = edit;
  longer.push_back(0);
  CHECK_FALSE(request(1, longer));
}

TEST_CASE("a commit is refused where it contradicts itself", "[protocol]") {
  const Bytes large_box = encode({FillBox{{{0, 0, 0}, {4096, 4096, 4096}}}, {}, 1});
  refuses<CommitFields>(
      Sender::server, FrameClass::edits,
      {[](auto& c) { c.epoch = 0; }, [](auto& c) { c.first = 0; }, [](auto& c) { c.first = ~0ULL; },
       [](auto& c) { c.edits = 0; }, [](auto& c) { c.edits = kCommitEditsMax + 1; },
       [](auto& c) { c.cause = kCauseMax + 1; }, [](auto& c) { c.edit.pop_back(); },
       [](auto& c) { c.subject = 10; },             // answers itself
       [](auto& c) { c.previous = {0}; },           // precedes itself
       [](auto& c) { c.previous = {11}; },          // before the log
       [](auto& c) { c.previous = {}; },            // one chunk is touched
       [](auto& c) { c.previous = {1, 1}; },        // only one
       [](auto& c) { c.previous = {0x81, 0x00}; },  // varint longer than needed
       [](auto& c) { c.previous = {0x81}; },        // and cut
       [&](auto& c) { c.edit = large_box; },        // 2^24 chunks: refused before they are listed
       [](auto& c) { c.previous = Bytes(kTouchedChunksMax + 1, 1), c.first = 10; },
       [](auto& c) { c.edits = 2000, c.shared = true, c.previous = Bytes(4000, 1); }});
  CommitFields from_base;
  from_base.previous = {10};
  from_base.subject = 9;
  const auto decoded = received(Sender::server, FrameClass::edits, from_base);
  REQUIRE(decoded.has_value());
  CHECK(std::get<Commit>(*decoded).edits[0].previous == std::vector<Sequence>{0});
  CHECK(std::get<Commit>(*decoded).edits[0].subject == 9);
}

TEST_CASE("lists of previous sequences that edits share cannot outgrow the message", "[protocol]") {
  // 128 KB on the wire would become 64 MB of sequences.
  CommitFields shared;
  shared.edits = 2000;
  shared.shared = true;
  shared.previous = Bytes(4000, 1);
  const auto decoded = received(Sender::server, FrameClass::edits, shared, 0);
  REQUIRE_FALSE(decoded.has_value());
  CHECK(decoded.error().what == std::string("commit shares its lists of previous sequences"));
}

TEST_CASE("times that could overflow a reader's arithmetic are refused", "[protocol]") {
  const auto pong = [](TimeUs sent, TimeUs server) {
    return passes_from_server([&](auto& b) { return wire::CreatePong(b, sent, server); },
                              FrameClass::control);
  };
  CHECK(pong(kWireTimeUsMax, -kWireTimeUsMax));
  CHECK_FALSE(pong(kWireTimeUsMax + 1, 0));
  CHECK_FALSE(pong(0, -kWireTimeUsMax - 1));
  CHECK_FALSE(pong(0, INT64_MIN));
}

TEST_CASE("answers and texts keep their bounds", "[protocol]") {
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
  CHECK(
      passes_from_client([](auto& b) { return wire::CreateGoodbye(b, 1); }));  // no text is no harm

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
  CHECK(audit(kAuditEntriesMax));
  CHECK_FALSE(audit(kAuditEntriesMax + 1));
  CHECK_FALSE(passes_from_server([](auto& b) {
    const std::vector<Offset<wire::DigestCheckEntry>> empty{wire::CreateDigestCheckEntry(b)};
    return wire::CreateDigestCheck(b, b.CreateVector(empty));
  }));
}

TEST_CASE("texts that are too long are cut when written, between characters", "[protocol]") {
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

TEST_CASE("a snapshot's digest can be held against its voxels", "[protocol]") {
  ChunkSnapshot snapshot;
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(kMessageEdge), 4);
  snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
  CHECK(digest_holds(snapshot));
  ++snapshot.chunk.digest.lane[1];
  CHECK_FALSE(digest_holds(snapshot));
}

TEST_CASE("raw snapshot bytes lie 4-aligned in their message", "[protocol]") {
  SplitMix64 rng{2};
  for (int step = 0; step < 20; ++step) {
    const EncodedMessage encoded = encode_message(random_message(rng, 6));
    const auto* chunk = wire::GetMessage(encoded.bytes->data())->body_as_Chunk();
    CHECK(reinterpret_cast<std::uintptr_t>(chunk->data()->data()) % 4 == 0);
  }
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

TEST_CASE("every reason has a name of its own", "[protocol]") {
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
