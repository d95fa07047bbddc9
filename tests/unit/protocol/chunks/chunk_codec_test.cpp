#include <catch2/catch.hpp>

#include <functional>

#include "common/runs/run_builder.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/chunks/chunk_size.hpp"
#include "tests/support/codec/packed_spelling.hpp"
#include "tests/support/core/hex.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

std::optional<ErrorCode> error_of(const Bytes& bytes) {
  const auto decoded = decode_chunk(bytes);
  if (decoded) return std::nullopt;
  return decoded.error().code;
}
std::optional<ErrorCode> error_of(std::string_view hex) { return error_of(from_hex(hex)); }

Bytes concat(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace

TEST_CASE("chunk bytes with a bad head are refused", "[protocol]") {
  CHECK(error_of("") == ErrorCode::truncated);
  CHECK(error_of("00 01 00 00 08080800 01000000 00020000") == ErrorCode::unknown_kind);
  CHECK(error_of("04 01 00 00 08080800 01000000 00020000") == ErrorCode::unknown_kind);
  REQUIRE_FALSE(error_of("01 01 00 00 08080800 01000000 00020000"));
  CHECK(error_of("01 02 00 00 08080800 01000000 00020000") == ErrorCode::bad_version);
  CHECK(error_of("01 00 00 00 08080800 01000000 00020000") == ErrorCode::bad_version);
  CHECK(error_of("01 01 06 00 08080800 01000000 00020000") == ErrorCode::bad_value);  // order
  CHECK(error_of("01 01 08 00 08080800 01000000 00020000") ==
        ErrorCode::bad_value);  // raw has no zstd flag
  CHECK(error_of("01 01 00 01 08080800 01000000 00020000") ==
        ErrorCode::not_canonical);  // reserved byte
  CHECK(error_of("01 01 00 00 08080801 01000000 00020000") == ErrorCode::not_canonical);
  CHECK(error_of("01 01 00 00 07080800 01000000 c0010000") == ErrorCode::bad_value);  // side 7
  CHECK(error_of("01 01 00 00 08810800 01000000 00000000") == ErrorCode::bad_value);  // side 129
}

TEST_CASE("raw runs that are not canonical are refused", "[protocol]") {
  const std::string head = "01 01 00 00 08080800 ";
  CHECK(error_of(head + "00000000") == ErrorCode::broken_invariant);    // no runs
  CHECK(error_of(head + "ffffffff 00020000") == ErrorCode::truncated);  // fewer runs than counted
  CHECK(error_of(head + "02000000 00020000") == ErrorCode::truncated);
  CHECK(error_of(head + "01000000 00020000 00") == ErrorCode::trailing_bytes);
  CHECK(error_of(head + "01000000 ff010000") ==
        ErrorCode::broken_invariant);  // ends before the volume
  CHECK(error_of(head + "01000000 01020000") ==
        ErrorCode::broken_invariant);  // ends behind the volume
  CHECK(error_of(head + "02000000 00000000 00020100") == ErrorCode::broken_invariant);  // empty run
  CHECK(error_of(head + "02000000 00020000 00010100") ==
        ErrorCode::broken_invariant);  // descending
  CHECK(error_of(head + "02000000 00010100 00020100") ==
        ErrorCode::broken_invariant);  // equal neighbours
  CHECK_FALSE(error_of(head + "02000000 00010100 00020000"));
}

TEST_CASE("the packed bytes that the next tests change are valid", "[protocol]") {
  RunBuilder builder({8, 8, 8}, AxisOrder::yxz);
  builder.append(3, 1);
  builder.append(197, 0);
  builder.append(312, 300);
  const RunChunk chunk = builder.finish();
  PackedSpelling plain;
  CHECK(encode_chunk(chunk, ChunkEncoding::packed) == plain.bytes());
  PackedSpelling zstd;
  zstd.order = 2 + 8;
  zstd.stored = zstd_frame(zstd.body);
  const auto decoded = decode_chunk(zstd.bytes());
  REQUIRE(decoded.has_value());
  CHECK(*decoded == chunk);
}

TEST_CASE("packed bytes whose fields contradict each other are refused", "[protocol]") {
  const struct {
    const char* what;
    std::function<void(PackedSpelling&)> bend;
    ErrorCode code;
  } cases[] = {
      {"version", [](auto& s) { s.version = 2; }, ErrorCode::bad_version},
      {"version 0", [](auto& s) { s.version = 0; }, ErrorCode::bad_version},
      {"order", [](auto& s) { s.order = 6; }, ErrorCode::bad_value},
      {"unknown flag", [](auto& s) { s.order = 2 + 16; }, ErrorCode::bad_value},
      {"side", [](auto& s) { s.sides = {8, 8, 129}; }, ErrorCode::bad_value},
      {"no runs", [](auto& s) { s.runs = 0; }, ErrorCode::bad_value},
      {"no runs, no palette", [](auto& s) { s.runs = 0, s.palette = {}; },
       ErrorCode::broken_invariant},
      {"more runs than voxels", [](auto& s) { s.runs = 513; }, ErrorCode::bad_value},
      {"runs beyond 64 bits of sense", [](auto& s) { s.runs = ~0ULL; }, ErrorCode::bad_value},
      {"palette larger than the runs", [](auto& s) { s.palette = {0, 0, 0, 0}; },
       ErrorCode::bad_value},
      {"palette size without palette",
       [](auto& s) { s.sides = {128, 128, 128}, s.runs = 70'000, s.palette_size = 65'536; },
       ErrorCode::truncated},
      {"palette above every limit", [](auto& s) { s.palette_size = 1ULL << 60; },
       ErrorCode::bad_value},
      {"id beyond 16 bits", [](auto& s) { s.palette = {0, 0, 65'534}; }, ErrorCode::bad_value},
      {"id step beyond 16 bits", [](auto& s) { s.palette = {0, 0, 1ULL << 40}; },
       ErrorCode::bad_value},
      {"unused palette entry", [](auto& s) { s.body = {1, 0, 1, 231, 3}; },
       ErrorCode::not_canonical},
      {"index behind the palette", [](auto& s) { s.body = {1, 0, 3, 231, 3}; },
       ErrorCode::broken_invariant},
      {"equal neighbours", [](auto& s) { s.runs = 4, s.body = {1, 0, 0, 2, 2, 3, 6}; },
       ErrorCode::broken_invariant},
      {"nothing left for the last run", [](auto& s) { s.body = {1, 0, 2, 192, 3}; },
       ErrorCode::broken_invariant},
      {"length behind the volume", [](auto& s) { s.body = {1, 0, 2, 0, 3, 0xff, 0x03}; },
       ErrorCode::broken_invariant},
      {"line behind the volume", [](auto& s) { s.body = {1, 0, 2, 192, 255}; },
       ErrorCode::broken_invariant},
      {"end of a line as a length", [](auto& s) { s.body = {1, 0, 2, 5, 3}; },
       ErrorCode::broken_invariant},
      {"end of a line as a long length", [](auto& s) { s.body = {1, 0, 2, 0, 3, 0xc5, 0x01}; },
       ErrorCode::broken_invariant},
      {"long length that fits a token", [](auto& s) { s.body = {1, 0, 2, 0, 3, 0xbf, 0x01}; },
       ErrorCode::broken_invariant},
      {"long length of three bytes that fits two",
       [](auto& s) { s.body = {1, 0, 2, 0, 3, 0xc6, 0x81, 0}; }, ErrorCode::broken_invariant},
      {"long length of 22 bits",
       [](auto& s) { s.sides = {32, 32, 32}, s.body = {1, 0, 2, 0, 3, 0x80, 0x80, 0x80, 1}; },
       ErrorCode::broken_invariant},
      {"long length is missing", [](auto& s) { s.body = {1, 0, 2, 0, 3}; },
       ErrorCode::broken_invariant},
      {"long length is cut", [](auto& s) { s.body = {1, 0, 2, 0, 3, 0xc6}; },
       ErrorCode::broken_invariant},
      {"a token too many", [](auto& s) { s.body = {1, 0, 2, 231, 3, 7}; },
       ErrorCode::trailing_bytes},
      {"body too small for its runs", [](auto& s) { s.body = {1, 0, 2, 231}; },
       ErrorCode::bad_value},
      {"no body", [](auto& s) { s.body = {}; }, ErrorCode::bad_value},
      {"body too large for its runs", [](auto& s) { s.body.resize(5 + 3 * (512 / 192) + 1); },
       ErrorCode::bad_value},
  };
  for (const auto& c : cases) {
    CAPTURE(c.what);
    PackedSpelling spelling;
    c.bend(spelling);
    CHECK(error_of(spelling.bytes()) == c.code);
  }
}

TEST_CASE("a varint of the head in more bytes than needed is refused", "[protocol]") {
  Bytes bytes{2, 1, 2, 8, 8, 8};
  spell_varint(bytes, 3, 1);
  bytes = concat(bytes, {3, 0, 0, 0xaa, 0x02, 1, 0, 2, 231, 3});
  CHECK(error_of(bytes) == ErrorCode::not_canonical);
}

TEST_CASE("a zstd frame that does not contain exactly the body is refused", "[protocol]") {
  PackedSpelling s;
  s.order = 2 + 8;
  const Bytes good = zstd_frame(s.body);
  const auto error_with = [&s](Bytes stored) {
    s.stored = std::move(stored);
    return error_of(s.bytes());
  };
  REQUIRE_FALSE(error_with(good));
  CHECK(error_with({}) == ErrorCode::bad_value);
  CHECK(error_with(zstd_frame(s.body, false)) == ErrorCode::bad_value);  // announces no size
  CHECK(error_with(zstd_frame(Bytes(4, 1))) == ErrorCode::bad_value);    // announces another size
  CHECK(error_with(zstd_frame(Bytes(12, 1))) == ErrorCode::bad_value);
  CHECK(error_with(concat(from_hex("28b52ffd"), good)) ==
        ErrorCode::bad_value);  // has the magic number
  CHECK(error_with(concat(good, {0})) == ErrorCode::trailing_bytes);
  CHECK(error_with(concat(concat(good, from_hex("28b52ffd")), good)) == ErrorCode::trailing_bytes);
  const Bytes skippable = from_hex("502a4d18 00000000");
  CHECK(error_with(concat(good, skippable)) == ErrorCode::trailing_bytes);
  CHECK(error_with(concat(skippable, good)) == ErrorCode::bad_value);
  CHECK(error_with(s.body) == ErrorCode::bad_value);  // not compressed
  for (std::size_t size = 1; size < good.size(); ++size) {
    CHECK(error_with(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))));
  }
}

TEST_CASE("the encoder compresses exactly if that makes the body smaller", "[protocol]") {
  SplitMix64 rng{4};
  const auto flag = [](const RunChunk& chunk) {
    return encode_chunk(chunk, ChunkEncoding::packed)[2] & 8;
  };
  CHECK(flag(uniform_chunk(Extent::cube(32), 5)) == 0);
  RunBuilder stripes({8, 8, 8}, AxisOrder::xyz);
  for (int i = 0; i < 512; ++i) stripes.append(1, static_cast<Material>(i % 2));
  CHECK(flag(stripes.finish()) != 0);
  int compressed = 0;
  for (int step = 0; step < 100; ++step) {
    const RunChunk chunk = random_chunk(rng, Extent::cube(16), random_order(rng), 4);
    if (flag(chunk) == 0) continue;
    ++compressed;
    const Bytes bytes = encode_chunk(chunk, ChunkEncoding::packed);
    const std::size_t body_least = 2 * chunk.runs.size() - 1;
    CHECK(bytes.size() < 6 + 3 + 2 + 12 + 2 * body_least);
  }
  CHECK(compressed > 20);
}

TEST_CASE("run lengths have the tokens of docs/protocol.md", "[protocol]") {
  const auto tokens_of = [](Extent extent, std::uint32_t first, std::uint32_t second) {
    RunBuilder builder(extent, AxisOrder::xyz);
    builder.append_to(first, 0);
    builder.append_to(second, 1);
    builder.append_to(extent.volume(), 2);
    const RunChunk chunk = builder.finish();
    const Bytes bytes = encode_chunk(chunk, ChunkEncoding::packed);
    REQUIRE(bytes[2] == 0);  // plain
    REQUIRE(decode_chunk(bytes).value() == chunk);
    return Bytes(bytes.begin() + 6 + 1 + 4 + 3, bytes.end());
  };
  const Extent cube = Extent::cube(32), odd{24, 32, 32};
  CHECK(tokens_of(cube, 1, 31) == Bytes{1, 30});
  CHECK(tokens_of(cube, 32, 64) == Bytes{255, 255});
  CHECK(tokens_of(cube, 31, 32) == Bytes{31, 255});
  CHECK(tokens_of(cube, 31, 64) == Bytes{31, 254});
  CHECK(tokens_of(cube, 191, 383) == Bytes{191, 0, 0xc0, 0x01});
  CHECK(tokens_of(cube, 192, 193) == Bytes{250, 1});
  CHECK(tokens_of(cube, 64 * 32, 64 * 32 + 1) == Bytes{192, 1});
  CHECK(tokens_of(cube, 65 * 32, 65 * 32 + 1) == Bytes{0, 1, 0xa0, 0x10});
  CHECK(tokens_of(cube, 31, 64 * 32) == Bytes{31, 192});
  CHECK(tokens_of(cube, 31, 65 * 32) == Bytes{31, 0, 0x81, 0x10});
  CHECK(tokens_of(odd, 8, 12) == Bytes{255, 4});  // a side of 24 has lines of 8
  CHECK(tokens_of(odd, 12, 24) == Bytes{12, 254});
}

TEST_CASE("palettes of more than 256 materials take two bytes an index", "[protocol]") {
  for (const unsigned materials : {255u, 256u, 257u, 4096u}) {
    CAPTURE(materials);
    RunBuilder builder(Extent::cube(16), AxisOrder::zxy);
    for (unsigned i = 0; i < materials; ++i) builder.append(1, static_cast<Material>(65'535 - i));
    builder.append_to(4096, builder.filled() == 4096 ? Material{0} : Material{65'535});
    const RunChunk chunk = builder.finish();
    const auto decoded = decode_chunk(encode_chunk(chunk, ChunkEncoding::packed));
    REQUIRE(decoded.has_value());
    CHECK(*decoded == chunk);
  }
}

TEST_CASE("a chunk of another extent than expected is refused in every encoding", "[protocol]") {
  const RunChunk chunk = uniform_chunk(Extent::cube(32), 3);
  for (const ChunkEncoding encoding :
       {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    const Bytes bytes = encode_chunk(chunk, encoding);
    CHECK(decode_chunk(bytes, Extent::cube(32)).has_value());
    CHECK_FALSE(decode_chunk(bytes, Extent::cube(16)).has_value());
    CHECK_FALSE(decode_chunk(bytes, Extent{32, 32, 16}).has_value());
  }
}

TEST_CASE("the largest chunk comes back from all encodings and fits its limit", "[protocol]") {
  SplitMix64 rng{9};
  const RunChunk chunk =
      random_chunk(rng, Extent::cube(128), AxisOrder::xyz, 65'536, ChunkShape::noise);
  REQUIRE(chunk.runs.size() > 2'000'000);
  for (const ChunkEncoding encoding :
       {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    const Bytes bytes = encode_chunk(chunk, encoding);
    CHECK(bytes.size() <= kChunkBytesMax);
    const auto decoded = decode_chunk(bytes);
    REQUIRE(decoded.has_value());
    CHECK(*decoded == chunk);
  }
}

}  // namespace runstone::test
