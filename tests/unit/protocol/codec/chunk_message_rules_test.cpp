#include "tests/unit/protocol/codec/built_message.hpp"

#include <limits>
#include <utility>
#include <vector>

namespace runstone::test {
namespace {

const EditDescriptor kEdit{SetVoxel{{1, 2, 3}}, {}, 1};

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

}  // namespace

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
  // Before Welcome the chunk edge is unknown.
  base.data = encode_chunk(uniform_chunk(Extent{8, 9, 10}, 1), ChunkEncoding::packed);
  CHECK(received(Sender::server, FrameClass::chunks, base, 0).has_value());
}

TEST_CASE(
    "uniform chunks are refused unless they ascend, lie inside the world and are not too many",
    "[protocol]") {
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
      read(joined(entry(0, 0, 0, 4'095), entry(1, 0, 0, 0))).has_value());  // too many in total
  CHECK_FALSE(
      read(joined(entry(0, 0, 0, 3), entry(0, 0, 3, 0))).has_value());  // the same chunk twice
  CHECK(read(joined(entry(0, 0, 0, 3), entry(0, 0, 4, 0))).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0), entry(0, -1, 0, 0))).has_value());  // descends
  CHECK(read(joined(entry(0, 0, 0, 0), entry(1, -1, 0, 0))).has_value());
  CHECK(read(entry(kReach - 1, -kReach, kReach - 4, 3)).has_value());
  CHECK_FALSE(read(entry(kReach, 0, 0, 0)).has_value());
  CHECK_FALSE(read(entry(0, -kReach - 1, 0, 0)).has_value());
  CHECK_FALSE(
      read(entry(0, 0, kReach - 4, 4)).has_value());  // the top chunk lies outside the world
  CHECK_FALSE(
      read(joined(entry(1, 0, 0, 0), entry(std::numeric_limits<std::int64_t>::max(), 0, 0, 0)))
          .has_value());
  CHECK_FALSE(read(entry(0, 0, 0, 0, 65'536)).has_value());
  CHECK_FALSE(
      read(joined(entry(0, 0, 0, 0, 1, 3), {0})).has_value());  // version without a sequence
  CHECK(read(joined(entry(0, 0, 0, 0, 1, 3), {9})).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0, 1, 1ULL << 32), {9})).has_value());
  Bytes cut = entry(-300, 70'000, 9, 100, 300, 0);
  CHECK_FALSE(read(joined(cut, {0})).has_value());
  while (!cut.empty()) {
    cut.pop_back();
    CHECK_FALSE(read(cut).has_value());
  }
}

TEST_CASE("unavailable chunks need keys inside the world, and may have an unknown reason",
          "[protocol]") {
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

TEST_CASE("lists of cached and unmodified chunks are refused unless canonical and inside the world",
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
  CHECK_FALSE(held(bytes_of({1, -2, 3}, {4, 0}, 7)));  // version without a sequence
  CHECK_FALSE(
      held(bytes_of({1, -2, 3}, {std::uint64_t{1} << 32, 500}, 7)));  // epoch exceeds 32 bits
  CHECK_FALSE(
      held(bytes_of({1, -2, 3}, {4, std::uint64_t{1} << 63}, 7)));  // sequence exceeds 63 bits
  CHECK_FALSE(
      held(bytes_of({1, -2, 3}, {0}, (std::uint64_t{1} << 61) - 1)));  // digest is not reduced
  CHECK(held(bytes_of({kReach - 1, 0, -kReach}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({kReach, 0, 0}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({0, 0, -kReach - 1}, {0}, 7)));
  CHECK_FALSE(held(bytes_of({std::int64_t{1} << 40, 0, 0}, {0}, 7)));
  const Bytes first = bytes_of({1, -2, 3}, {0}, 7);
  CHECK(held(joined(first, bytes_of({0, 0, 1}, {0}, 7))));
  CHECK_FALSE(held(joined(first, bytes_of({0, 0, 0}, {0}, 7))));   // the same key
  CHECK_FALSE(held(joined(first, bytes_of({0, -1, 5}, {0}, 7))));  // descends
  CHECK_FALSE(held(joined(first, {0})));
  Bytes many = first;
  for (std::size_t i = 1; i < kCachedChunksMax; ++i)
    many = joined(many, bytes_of({0, 0, 1}, {0}, 7));
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

TEST_CASE("chunk edits are refused unless they lead from one version to the other", "[protocol]") {
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

TEST_CASE("a history request is refused with a field that its target does not use", "[protocol]") {
  const auto request = [](std::uint32_t number, std::uint8_t to, Sequence seq, TimeUs utc_us) {
    return passes_from_client(
        [=](auto& b) { return wire::CreateHistoryRequest(b, number, to, seq, utc_us); });
  };
  CHECK(request(1, 0, 0, 0));
  CHECK(request(1, 1, kSequenceMax, 0));
  CHECK(request(1, 2, 0, -kWireTimeUsMax));
  CHECK_FALSE(request(0, 0, 0, 0));
  CHECK_FALSE(request(1, 3, 0, 0));
  CHECK_FALSE(request(1, 0, 5, 0));
  CHECK_FALSE(request(1, 2, 5, 0));
  CHECK_FALSE(request(1, 1, 5, 5));
  CHECK_FALSE(request(1, 1, kSequenceMax + 1, 0));
  CHECK_FALSE(request(1, 2, 0, kWireTimeUsMax + 1));
}

TEST_CASE("a history state is refused outside its bounds", "[protocol]") {
  const auto state = [](std::uint32_t number, std::uint8_t phase, bool past, Sequence seq,
                        TimeUs utc_us = 0) {
    return passes_from_server(
        [=](auto& b) { return wire::CreateViewState(b, number, phase, past, seq, utc_us); },
        FrameClass::chunks);
  };
  CHECK(state(1, 1, true, kSequenceMax, kWireTimeUsMax));
  CHECK(state(1, 3, false, 0));
  CHECK_FALSE(state(0, 1, true, 5));
  CHECK_FALSE(state(1, 0, true, 5));
  CHECK_FALSE(state(1, 4, true, 5));
  CHECK_FALSE(state(1, 1, false, 5));
  CHECK_FALSE(state(1, 1, true, kSequenceMax + 1));
  CHECK_FALSE(state(1, 1, true, 5, kWireTimeUsMax + 1));
}

TEST_CASE("a digest that is not that of the voxels is noticed", "[protocol]") {
  ChunkSnapshot snapshot;
  snapshot.chunk.voxels = uniform_chunk(Extent::cube(kMessageEdge), 4);
  snapshot.chunk.digest = digest_of(snapshot.chunk.voxels);
  CHECK(digest_matches(snapshot));
  ++snapshot.chunk.digest.lane[1];
  CHECK_FALSE(digest_matches(snapshot));
}

TEST_CASE("raw snapshot bytes lie 4-aligned in their message", "[protocol]") {
  SplitMix64 rng{2};
  for (int step = 0; step < 20; ++step) {
    const EncodedMessage encoded = encode_message(random_message(rng, 6));
    const auto* chunk = wire::GetMessage(encoded.bytes->data())->body_as_Chunk();
    CHECK(reinterpret_cast<std::uintptr_t>(chunk->data()->data()) % 4 == 0);
  }
}

}  // namespace runstone::test
