#include "common/core/bytes.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <vector>

#include "common/core/hash.hpp"

using namespace runstone;

namespace {

Bytes varint_bytes(std::uint64_t v) {
  Bytes out;
  ByteWriter(out).varint(v);
  return out;
}

ErrorCode varint_error(const Bytes& in) {
  ByteReader reader(in);
  reader.varint();
  REQUIRE_FALSE(reader.ok());
  return reader.error().code;
}

const std::vector<std::uint64_t> kVarints = {0,
                                             1,
                                             127,
                                             128,
                                             16383,
                                             16384,
                                             0xffff,
                                             0xffffffff,
                                             (1ULL << 56) - 1,
                                             1ULL << 56,
                                             (1ULL << 63) - 1,
                                             1ULL << 63,
                                             std::numeric_limits<std::uint64_t>::max()};

}  // namespace

TEST_CASE("fixed-width integers are little-endian", "[core][bytes]") {
  Bytes out;
  ByteWriter w(out);
  w.u8(0x01);
  w.u16(0x0302);
  w.u32(0x07060504);
  w.u64(0x0f0e0d0c0b0a0908);
  REQUIRE(out == Bytes{1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15});
  ByteReader r(out);
  CHECK(r.u8() == 0x01);
  CHECK(r.u16() == 0x0302);
  CHECK(r.u32() == 0x07060504);
  CHECK(r.u64() == 0x0f0e0d0c0b0a0908);
  CHECK(r.finish().has_value());
}

TEST_CASE("varints have golden bytes", "[core][bytes]") {
  CHECK(varint_bytes(0) == Bytes{0x00});
  CHECK(varint_bytes(127) == Bytes{0x7f});
  CHECK(varint_bytes(128) == Bytes{0x80, 0x01});
  CHECK(varint_bytes(300) == Bytes{0xac, 0x02});
  CHECK(varint_bytes(std::numeric_limits<std::uint64_t>::max()) ==
        Bytes{0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01});
}

TEST_CASE("varints round-trip at every width and every truncation of them fails", "[core][bytes]") {
  for (const std::uint64_t v : kVarints) {
    CAPTURE(v);
    const Bytes bytes = varint_bytes(v);
    ByteReader whole(bytes);
    CHECK(whole.varint() == v);
    CHECK(whole.finish().has_value());
    for (std::size_t keep = 0; keep < bytes.size(); ++keep) {
      const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(keep));
      CAPTURE(keep);
      CHECK(varint_error(cut) == ErrorCode::truncated);
    }
  }
}

TEST_CASE("only the shortest encoding of a varint is accepted", "[core][bytes]") {
  for (const std::uint64_t v : kVarints) {
    CAPTURE(v);
    Bytes longer = varint_bytes(v);
    if (longer.size() == 10) continue;  // one byte more would exceed 64 bits
    longer.back() |= 0x80;
    longer.push_back(0x00);
    CHECK(varint_error(longer) == ErrorCode::not_canonical);
  }
  CHECK(varint_error({0x80, 0x00}) == ErrorCode::not_canonical);
  CHECK(varint_error({0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x00}) ==
        ErrorCode::not_canonical);
}

TEST_CASE("varints beyond 64 bits are rejected", "[core][bytes]") {
  CHECK(varint_error({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x02}) ==
        ErrorCode::bad_value);
  CHECK(varint_error({0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x81, 0x00}) ==
        ErrorCode::bad_value);
  CHECK(varint_error(Bytes(64, 0xff)) == ErrorCode::bad_value);
}

TEST_CASE("every accepted varint is the one the writer makes", "[core][bytes]") {
  SplitMix64 rng(11);
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    Bytes in(1 + rng.below(10));
    for (auto& b : in)
      b = static_cast<std::uint8_t>(rng.below(3) == 0 ? rng.below(2) : 0x80 | rng.below(128));
    ByteReader r(in);
    const std::uint64_t v = r.varint();
    if (!r.ok()) continue;
    ++accepted;
    CHECK(varint_bytes(v) ==
          Bytes(in.begin(), in.begin() + static_cast<std::ptrdiff_t>(r.offset())));
  }
  CHECK(accepted > 1000);
}

TEST_CASE("zigzag orders small magnitudes first and inverts at the limits", "[core][bytes]") {
  CHECK(zigzag(0) == 0);
  CHECK(zigzag(-1) == 1);
  CHECK(zigzag(1) == 2);
  CHECK(zigzag(-2) == 3);
  for (const std::int64_t v :
       {std::numeric_limits<std::int64_t>::min(), std::int64_t{-1}, std::int64_t{0},
        std::int64_t{77}, std::numeric_limits<std::int64_t>::max()}) {
    CHECK(unzigzag(zigzag(v)) == v);
    Bytes out;
    ByteWriter(out).svarint(v);
    ByteReader r(out);
    CHECK(r.svarint() == v);
    CHECK(r.finish().has_value());
  }
}

TEST_CASE("bounded varints accept their bounds and reject values beyond them", "[core][bytes]") {
  const Bytes nine = varint_bytes(9);
  CHECK(ByteReader(nine).varint_max(9, "n") == 9);
  ByteReader over(nine);
  CHECK(over.varint_max(8, "n") == 0);
  CHECK(over.error().code == ErrorCode::bad_value);

  Bytes minus;
  ByteWriter(minus).svarint(-5);
  CHECK(ByteReader(minus).svarint_in(-5, 5, "n") == -5);
  ByteReader below(minus);
  CHECK(below.svarint_in(-4, 4, "n") == -4);  // a value that the caller can use safely
  CHECK_FALSE(below.ok());
}

TEST_CASE("after the first failure every read fails and the error keeps its offset",
          "[core][bytes]") {
  const Bytes in = {1, 2, 3};
  ByteReader r(in);
  CHECK(r.u16() == 0x0201);
  CHECK(r.u32() == 0);
  REQUIRE_FALSE(r.ok());
  CHECK(r.error().code == ErrorCode::truncated);
  CHECK(r.error().offset == 2);
  CHECK(r.u8() == 0);
  CHECK(r.varint() == 0);
  CHECK(r.bytes(0).empty());
  r.reject(ErrorCode::bad_value, "later");
  CHECK(r.error().code == ErrorCode::truncated);
  CHECK(r.finish().error().code == ErrorCode::truncated);
}

TEST_CASE("byte strings are views of the input and never leave it", "[core][bytes]") {
  const Bytes in = {9, 8, 7};
  ByteReader r(in);
  const ByteView two = r.bytes(2);
  REQUIRE(two.size() == 2);
  CHECK(two.data() == in.data());
  CHECK(r.left() == 1);
  CHECK(r.bytes(std::numeric_limits<std::size_t>::max()).empty());
  CHECK(r.error().code == ErrorCode::truncated);
}

TEST_CASE("bytes left over are an error", "[core][bytes]") {
  const Bytes in = {5, 0};
  ByteReader r(in);
  CHECK(r.varint() == 5);
  const Result<void> done = r.finish();
  REQUIRE_FALSE(done.has_value());
  CHECK(done.error().code == ErrorCode::trailing_bytes);
  CHECK(done.error().offset == 1);
}
