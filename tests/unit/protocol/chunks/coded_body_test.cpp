#include "protocol/chunks/coded_body.hpp"

#include <catch2/catch.hpp>

#include <string>
#include <vector>

#include "common/core/hash.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "protocol/chunks/range_coder.hpp"
#include "tests/support/core/hex.hpp"

namespace runstone::test {
namespace {

/// Chunk bytes of 8x8x8 in order xyz with palette 0, 1 and this body.
Bytes with_body(const Bytes& body, const char* palette = "02 00 00") {
  Bytes out = from_hex("03 01 00 08 08 08");
  for (const Bytes& part : {from_hex(palette), body})
    out.insert(out.end(), part.begin(), part.end());
  return out;
}

ErrorCode coded_error(const Bytes& bytes) {
  const auto decoded = decode_chunk(bytes);
  REQUIRE_FALSE(decoded.has_value());
  return decoded.error().code;
}

/// Returns a body of these bits. Each bit meets a fresh model, except the bits of a palette index.
class Spelling {
 public:
  Spelling& index(bool bit) { return put(material_, bit); }
  Spelling& fresh(bool bit) {
    AdaptiveBit model;
    return put(model, bit);
  }
  Bytes bytes() {
    coder_.finish();
    return with_body(body_);
  }

 private:
  Spelling& put(AdaptiveBit& model, bool bit) {
    coder_.code(model, bit);
    return *this;
  }
  Bytes body_;
  RangeEncoder coder_{body_};
  AdaptiveBit material_;
};

}  // namespace

TEST_CASE("bits come back from a range coder, whatever their probability", "[protocol]") {
  SplitMix64 rng{4};
  for (const unsigned ones : {0u, 1u, 50u, 128u, 250u, 256u}) {
    CAPTURE(ones);
    std::vector<bool> bits;
    for (int i = 0; i < 20'000; ++i) bits.push_back(rng.below(256) < ones);
    Bytes bytes = {7};  // must stay
    AdaptiveBit model;
    RangeEncoder encoder(bytes);
    for (const bool bit : bits) encoder.code(model, bit);
    encoder.finish();
    CHECK(bytes[0] == 7);
    if (ones % 256 == 0) CHECK(bytes.size() < 20);
    CHECK(bytes.size() < 2750);  // at most 10 % above one bit each

    const ByteView body = ByteView(bytes).subspan(1);
    model = {};
    RangeDecoder decoder(body);
    for (const bool bit : bits) REQUIRE(decoder.code(model, false) == bit);
    CHECK(decoder.finish().has_value());
  }
}

TEST_CASE("a carry passes through bytes of 255", "[protocol]") {
  // Every ninth bit contradicts a model that has learnt the other value, so many sums end with a
  // carry.
  for (int period = 2; period < 40; ++period) {
    CAPTURE(period);
    Bytes bytes;
    AdaptiveBit model;
    RangeEncoder encoder(bytes);
    for (int i = 0; i < 5000; ++i) encoder.code(model, i % period != 0);
    encoder.finish();
    model = {};
    RangeDecoder decoder(bytes);
    for (int i = 0; i < 5000; ++i) REQUIRE(decoder.code(model, false) == (i % period != 0));
    CHECK(decoder.finish().has_value());
  }
}

TEST_CASE("canonical coded runs are decoded", "[protocol]") {
  RunChunk chunk{{8, 8, 8}, AxisOrder::xyz, RunList(512)};
  chunk.runs.push_back({3, 0});
  chunk.runs.push_back({512, 1});
  const auto decoded = decode_chunk(encode_chunk(chunk, ChunkEncoding::coded));
  REQUIRE(decoded.has_value());
  CHECK(*decoded == chunk);
}

TEST_CASE("coded bytes whose fields contradict each other are refused", "[protocol]") {
  CHECK(coded_error(with_body({})) == ErrorCode::truncated);
  CHECK(coded_error(with_body({0xff, 0xff, 0xff, 0xff})) != ErrorCode::unknown_kind);
  CHECK(coded_error(with_body({0}, "01 05")) ==
        ErrorCode::trailing_bytes);  // one material needs no body
  CHECK(coded_error(with_body({}, "00")) == ErrorCode::broken_invariant);  // no material
  CHECK(coded_error(with_body({}, "03 00 00")) ==
        ErrorCode::truncated);  // counts three materials, has two
  CHECK(coded_error(with_body({}, "81 04 00 00")) ==
        ErrorCode::bad_value);  // more materials than voxels
  CHECK(coded_error(from_hex("03 02 00 08 08 08 01 00")) == ErrorCode::bad_version);
  CHECK(coded_error(from_hex("03 01 08 08 08 08 01 00")) ==
        ErrorCode::bad_value);  // the zstd flag of packed
  CHECK(coded_error(from_hex("03 01 00 07 08 08 01 00")) == ErrorCode::bad_value);
  CHECK(decode_chunk(from_hex("03 01 00 08 08 08 01 05")).has_value());

  // A run that ends behind its stretch: distance 7, at most 6.
  CHECK(coded_error(
            Spelling().index(false).fresh(true).fresh(true).fresh(true).fresh(true).bytes()) ==
        ErrorCode::not_canonical);
  // A change to the same material.
  CHECK(coded_error(Spelling()
                        .index(false)
                        .fresh(true)
                        .fresh(false)
                        .fresh(false)
                        .fresh(false)
                        .index(false)
                        .bytes()) == ErrorCode::not_canonical);
  // A palette index of 3 in two bits; there are three materials.
  AdaptiveBit high, low;
  Bytes body;
  RangeEncoder coder(body);
  coder.code(high, true);
  coder.code(low, true);
  coder.finish();
  CHECK(coded_error(with_body(body, "03 00 00 00")) == ErrorCode::not_canonical);
}

TEST_CASE("a palette with a material that no coded run has is refused", "[protocol]") {
  // All voxels have index 0. Stretches begin at 0, 8 and 64, without a change.
  Bytes body;
  RangeEncoder coder(body);
  AdaptiveBit index, line, start, layer, rest;
  coder.code(index, false);
  coder.code(line, false);
  coder.code(start, false);
  coder.code(layer, false);
  coder.code(start, false);
  coder.code(rest, false);
  coder.finish();
  const auto decoded = decode_chunk(with_body(body));
  REQUIRE_FALSE(decoded.has_value());
  CHECK(decoded.error().code == ErrorCode::not_canonical);
  CHECK(std::string(decoded.error().what) == "palette names a material that no run has");
}

TEST_CASE("no two short bodies decode to the same chunk", "[protocol]") {
  for (unsigned bits = 0; bits < 65'536; ++bits) {
    const Bytes bytes =
        with_body({static_cast<std::uint8_t>(bits >> 8), static_cast<std::uint8_t>(bits & 255)});
    const auto decoded = decode_chunk(bytes);
    if (decoded) REQUIRE(encode_chunk(*decoded, ChunkEncoding::coded) == bytes);
  }
}

}  // namespace runstone::test
