// Rules of the byte lists whose entries begin with a chunk key.
#include <limits>
#include <string>
#include <vector>

#include "tests/unit/protocol/codec/built_message.hpp"

namespace runstone::test {
namespace {

/// A byte list of one kind of message.
struct ListKind {
  const char* name;
  std::size_t count_max;
  Bytes tail;  // what follows the key in each entry
  /// Decodes a message with these list bytes.
  std::function<Result<Message>(const Bytes&)> read;
};

Bytes concat(std::initializer_list<Bytes> parts) {
  Bytes bytes;
  for (const Bytes& part : parts) bytes.insert(bytes.end(), part.begin(), part.end());
  return bytes;
}

template <class T, class Create>
std::function<Result<Message>(const Bytes&)> reader(Create create) {
  return [create](const Bytes& bytes) {
    return received<T>([&](FlatBufferBuilder& b) { return create(b, b.CreateVector(bytes)); });
  };
}

std::vector<ListKind> list_kinds() {
  const Bytes chunk =
      encode_chunk(uniform_chunk(Extent::cube(kMessageEdge), 1), ChunkEncoding::coded);
  const Bytes snapshot =
      concat({{0, 0}, u64_bytes(5), u64_bytes(6), varints({chunk.size()}), chunk});
  return {
      {"ChunkRequest", kChunkRequestKeysMax, {}, reader<ChunkRequest>([](auto& b, auto v) {
         return wire::CreateChunkRequest(b, v);
       })},
      {"ChunkUnavailable", kUnavailableKeysMax, {}, reader<ChunkUnavailable>([](auto& b, auto v) {
         return wire::CreateChunkUnavailable(b, 1, v, 1);
       })},
      {"CachedChunks", kCachedChunksMax, concat({{0}, u64_bytes(7)}),
       reader<CachedChunks>([](auto& b, auto v) { return wire::CreateCachedChunks(b, v); })},
      {"ChunksNotModified",
       kChunksNotModifiedMax,
       {0},
       reader<ChunksNotModified>(
           [](auto& b, auto v) { return wire::CreateChunksNotModified(b, 1, v); })},
      {"DigestCheck", kDigestCheckEntriesMax, concat({{0}, u64_bytes(5), u64_bytes(6)}),
       reader<DigestCheck>([](auto& b, auto v) { return wire::CreateDigestCheck(b, v); })},
      {"UniformChunks", kUniformChunksMax, {0, 1, 0}, reader<UniformChunks>([](auto& b, auto v) {
         return wire::CreateUniformChunks(b, 1, v);
       })},
      {"Chunks", kChunksPerMessageMax, snapshot,
       reader<Chunks>([](auto& b, auto v) { return wire::CreateChunks(b, 1, v); })},
  };
}

}  // namespace

TEST_CASE("every list of chunks ascends by x, then y, then z", "[protocol]") {
  for (const ListKind& list : list_kinds()) {
    CAPTURE(list.name);
    const auto entry = [&list](std::int64_t x, std::int64_t y, std::int64_t z) {
      return joined(svarints({x, y, z}), list.tail);
    };
    const auto after_first = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return list.read(joined(entry(5, 5, 5), entry(x, y, z))).has_value();
    };
    CHECK(after_first(0, 0, 1));
    CHECK(after_first(0, 1, -9));
    CHECK(after_first(1, -9, -9));
    CHECK_FALSE(after_first(0, 0, 0));  // the same key
    CHECK_FALSE(after_first(0, 0, -1));
    CHECK_FALSE(after_first(0, -1, 9));
    CHECK_FALSE(after_first(-1, 9, 9));
    // The first key is a difference to (0, 0, 0), and may lie before it.
    CHECK(list.read(entry(-1, -1, -1)).has_value());
  }
}

TEST_CASE("every list of chunks holds keys inside the world only", "[protocol]") {
  for (const ListKind& list : list_kinds()) {
    CAPTURE(list.name);
    const auto entry = [&list](std::int64_t x, std::int64_t y, std::int64_t z) {
      return joined(svarints({x, y, z}), list.tail);
    };
    const auto passes_at = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
      return list.read(entry(x, y, z)).has_value();
    };
    CHECK(passes_at(kReach - 1, -kReach, 0));
    CHECK(passes_at(-kReach, 0, kReach - 1));
    CHECK_FALSE(passes_at(kReach, 0, 0));
    CHECK_FALSE(passes_at(0, -kReach - 1, 0));
    CHECK_FALSE(passes_at(0, 0, kReach));
    constexpr std::int64_t kMost = std::numeric_limits<std::int64_t>::max();
    CHECK_FALSE(passes_at(kMost, 0, 0));
    CHECK_FALSE(passes_at(0, 0, -kMost - 1));
    // Differences that lead out of the world, and sums that would overflow.
    CHECK(list.read(joined(entry(-kReach, 0, 0), entry(2 * kReach - 1, 0, 0))).has_value());
    CHECK_FALSE(list.read(joined(entry(-kReach, 0, 0), entry(2 * kReach, 0, 0))).has_value());
    CHECK_FALSE(list.read(joined(entry(1, 0, 0), entry(kMost, 0, 0))).has_value());
  }
}

TEST_CASE("every list of chunks has one entry at least, and a largest count", "[protocol]") {
  for (const ListKind& list : list_kinds()) {
    CAPTURE(list.name);
    CHECK_FALSE(list.read({}).has_value());
    const Bytes next = joined(svarints({0, 0, 1}), list.tail);
    Bytes bytes;
    for (std::size_t i = 0; i < list.count_max; ++i)
      bytes.insert(bytes.end(), next.begin(), next.end());
    CHECK(list.read(bytes).has_value());
    const auto one_more = list.read(joined(bytes, next));
    REQUIRE_FALSE(one_more.has_value());
    CHECK(one_more.error().code == ErrorCode::limit_exceeded);
  }
}

TEST_CASE("a list of chunks that ends inside an entry is refused", "[protocol]") {
  for (const ListKind& list : list_kinds()) {
    CAPTURE(list.name);
    const Bytes entry = joined(svarints({300, -70'000, 9}), list.tail);
    const Bytes both = joined(entry, entry);
    REQUIRE_FALSE(both.empty());
    for (std::size_t size = 0; size <= both.size(); ++size) {
      CAPTURE(size);
      const auto read =
          list.read(Bytes(both.begin(), both.begin() + static_cast<std::ptrdiff_t>(size)));
      // The second key is twice the first one: it ascends by x.
      CHECK(read.has_value() == (size == entry.size() || size == both.size()));
    }
  }
}

TEST_CASE("a list of chunks that answers no view is refused", "[protocol]") {
  const auto view = [](std::uint32_t number) {
    return std::vector<bool>{
        passes<ChunkUnavailable>([=](auto& b) {
          return wire::CreateChunkUnavailable(b, number, b.CreateVector(Bytes{0, 0, 0}), 1);
        }),
        passes<ChunksNotModified>([=](auto& b) {
          return wire::CreateChunksNotModified(b, number, b.CreateVector(Bytes{0, 0, 0, 0}));
        }),
        passes<UniformChunks>([=](auto& b) {
          return wire::CreateUniformChunks(b, number, b.CreateVector(Bytes{0, 0, 0, 0, 1, 0}));
        }),
        passes<Chunks>([=](auto& b) {
          const Bytes entry = joined({0, 0, 0}, list_kinds().back().tail);
          return wire::CreateChunks(b, number, b.CreateVector(entry));
        })};
  };
  CHECK(view(1) == std::vector<bool>(4, true));
  CHECK(view(0xffff'ffff) == std::vector<bool>(4, true));
  CHECK(view(0) == std::vector<bool>(4, false));
}

TEST_CASE("a message without its list is refused", "[protocol]") {
  CHECK_FALSE(passes<ChunkRequest>([](auto& b) { return wire::CreateChunkRequest(b); }));
  CHECK_FALSE(
      passes<ChunkUnavailable>([](auto& b) { return wire::CreateChunkUnavailable(b, 1, 0, 1); }));
  CHECK_FALSE(passes<CachedChunks>([](auto& b) { return wire::CreateCachedChunks(b); }));
  CHECK_FALSE(
      passes<ChunksNotModified>([](auto& b) { return wire::CreateChunksNotModified(b, 1); }));
  CHECK_FALSE(passes<DigestCheck>([](auto& b) { return wire::CreateDigestCheck(b); }));
  CHECK_FALSE(passes<UniformChunks>([](auto& b) { return wire::CreateUniformChunks(b, 1); }));
  CHECK_FALSE(passes<Chunks>([](auto& b) { return wire::CreateChunks(b, 1); }));
}

TEST_CASE("versions and digests in lists have one spelling and stay in range", "[protocol]") {
  const auto cached = [](std::initializer_list<std::uint64_t> version, std::uint64_t lane) {
    const Bytes bytes = concat({{0, 0, 0}, varints(version), u64_bytes(lane)});
    return passes<CachedChunks>(
        [&](auto& b) { return wire::CreateCachedChunks(b, b.CreateVector(bytes)); });
  };
  const auto checked = [](std::initializer_list<std::uint64_t> version, std::uint64_t lane) {
    const Bytes bytes = concat({{0, 0, 0}, varints(version), u64_bytes(5), u64_bytes(lane)});
    return passes<DigestCheck>(
        [&](auto& b) { return wire::CreateDigestCheck(b, b.CreateVector(bytes)); });
  };
  constexpr std::uint64_t kPrime = (std::uint64_t{1} << 61) - 1;
  for (const auto& read :
       {std::function<bool(std::initializer_list<std::uint64_t>, std::uint64_t)>(cached),
        {checked}}) {
    CHECK(read({0}, 7));
    CHECK(read({4, 500}, kPrime - 1));
    CHECK(read({0xffff'ffff, kSequenceMax}, 7));
    CHECK_FALSE(read({0, 500}, 7));                       // the base has no sequence
    CHECK_FALSE(read({4, 0}, 7));                         // version without a sequence
    CHECK_FALSE(read({std::uint64_t{1} << 32, 500}, 7));  // epoch exceeds 32 bits
    CHECK_FALSE(read({4, kSequenceMax + 1}, 7));
    CHECK_FALSE(read({0}, kPrime));  // digest is not reduced
    CHECK_FALSE(read({0}, ~0ULL));
  }
}

TEST_CASE("sequences of unmodified chunks are differences that stay in range", "[protocol]") {
  const auto same = [](const Bytes& bytes) {
    return received<ChunksNotModified>(
        [&](auto& b) { return wire::CreateChunksNotModified(b, 1, b.CreateVector(bytes)); });
  };
  const auto two = same({2, 0, 0, 10, 0, 0, 2, 9});
  REQUIRE(two.has_value());
  CHECK(std::get<ChunksNotModified>(*two).chunks ==
        std::vector<UnmodifiedChunk>{{{0, {1, 0, 0}}, 5}, {{0, {1, 0, 1}}, 0}});
  CHECK_FALSE(same({2, 0, 0, 10, 0, 0, 2, 11}).has_value());  // at -1
  CHECK_FALSE(same({2, 0, 0, 1}).has_value());
}

TEST_CASE("an entry of uniform chunks stays inside the world and below the limit", "[protocol]") {
  const auto read = [](const Bytes& bytes) {
    return received<UniformChunks>(
        [&](auto& b) { return wire::CreateUniformChunks(b, 1, b.CreateVector(bytes)); });
  };
  const auto entry = [](std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t more,
                        std::uint64_t material = 1, std::uint64_t epoch = 0) {
    return joined(svarints({x, y, z}), varints({more, material, epoch}));
  };
  const auto whole = read(entry(0, 0, -5, 4'095));
  REQUIRE(whole.has_value());
  CHECK(std::get<UniformChunks>(*whole).chunks.size() == 4'096);
  CHECK(std::get<UniformChunks>(*whole).chunks.back() == UniformChunk{{0, {0, 0, 4'090}}, 1, {}});
  CHECK_FALSE(read(entry(0, 0, 0, 4'096)).has_value());
  // Too many in total.
  CHECK_FALSE(read(joined(entry(0, 0, 0, 4'095), entry(1, 0, 0, 0))).has_value());
  // The key is a difference to the first chunk of the entry before, and lies behind its last one.
  CHECK_FALSE(read(joined(entry(0, 0, 0, 3), entry(0, 0, 3, 0))).has_value());
  CHECK(read(joined(entry(0, 0, 0, 3), entry(0, 0, 4, 0))).has_value());
  CHECK(read(entry(kReach - 1, -kReach, kReach - 4, 3)).has_value());
  CHECK_FALSE(read(entry(0, 0, kReach - 4, 4)).has_value());  // the last chunk lies outside
  CHECK_FALSE(read(entry(0, 0, 0, 0, 65'536)).has_value());
  CHECK_FALSE(read(joined(entry(0, 0, 0, 0, 1, 3), {0})).has_value());  // without a sequence
  CHECK(read(joined(entry(0, 0, 0, 0, 1, 3), {9})).has_value());
}

TEST_CASE("unavailable chunks may have an unknown reason, but not 0", "[protocol]") {
  const auto read = [](std::uint8_t reason) {
    return received<ChunkUnavailable>([&](auto& b) {
      return wire::CreateChunkUnavailable(b, 3, b.CreateVector(Bytes{2, 0, 0}), reason);
    });
  };
  const auto unknown = read(255);
  REQUIRE(unknown.has_value());
  CHECK(std::get<ChunkUnavailable>(*unknown).view == 3);
  CHECK(to_string(std::get<ChunkUnavailable>(*unknown).reason) == std::string("unknown"));
  CHECK_FALSE(read(0).has_value());
}

TEST_CASE("claims of tiles have a level of at most 8, and keys of that level inside the world",
          "[protocol]") {
  const auto claim = [](std::uint64_t x, std::uint8_t level) {
    const Bytes bytes = concat({varints({x, 0, 0}), {0}, u64_bytes(7)});
    return received<CachedChunks>(
        [&](auto& b) { return wire::CreateCachedChunks(b, b.CreateVector(bytes), level); });
  };
  const auto same = [](std::uint64_t x, std::uint8_t level) {
    const Bytes bytes = concat({varints({x, 0, 0}), {0}});
    return received<ChunksNotModified>(
        [&](auto& b) { return wire::CreateChunksNotModified(b, 1, b.CreateVector(bytes), level); });
  };
  for (std::uint8_t level = 0; level <= kTileLevelMax; ++level) {
    const std::uint64_t reach = static_cast<std::uint64_t>(kWorldLimit / kMessageEdge) >> level;
    const std::uint64_t last = 2 * (reach - 1);  // zigzag
    const auto claimed = claim(last, level);
    REQUIRE(claimed.has_value());
    CHECK(std::get<CachedChunks>(*claimed).chunks[0].key ==
          ChunkKey{level, {static_cast<std::int32_t>(reach) - 1, 0, 0}});
    CHECK(same(last, level).has_value());
    CHECK_FALSE(claim(last + 2, level).has_value());
    CHECK_FALSE(same(last + 2, level).has_value());
  }
  CHECK_FALSE(claim(0, kTileLevelMax + 1).has_value());
  CHECK_FALSE(same(0, kTileLevelMax + 1).has_value());
  CHECK_FALSE(claim(0, 255).has_value());
}

TEST_CASE("claims of several levels become messages of one level each", "[protocol]") {
  std::vector<CachedChunk> claims;
  for (std::uint8_t level = 0; level <= 3; ++level) {
    for (std::int32_t x = 0; x < 300; ++x) claims.push_back({{level, {x, 0, 0}}, {}, 1});
  }
  std::vector<CachedChunk> read;
  for (const Message& message : cached_chunks_messages(claims)) {
    const auto& chunks = std::get<CachedChunks>(message).chunks;
    CHECK(chunks.front().key.lod == chunks.back().key.lod);
    CHECK(encode_message(message).bytes->size() <= kClientControlBytesMax);
    read.insert(read.end(), chunks.begin(), chunks.end());
  }
  CHECK(read == claims);
}

}  // namespace runstone::test
