#include <catch2/catch.hpp>
#include <string>

#include "common/runs/run_builder.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/core/hex.hpp"
#include "tests/support/core/page_example.hpp"

// The bytes were computed by hand from docs/protocol.md, coded bodies by a second decoder that was
// written from it. They are on the wire and in stores: a change here is a new version of chunk
// bytes.
namespace runstone::test {
namespace {

void check_bytes(const RunChunk& chunk, ChunkEncoding encoding, const std::string& golden) {
  CHECK(to_hex(encode_chunk(chunk, encoding)) == to_hex(from_hex(golden)));
  const auto decoded = decode_chunk(from_hex(golden));
  REQUIRE(decoded.has_value());
  CHECK(*decoded == chunk);
}

/// Three voxels of stone, 197 of air, the rest of material 300, y fastest.
RunChunk three_runs() {
  RunBuilder builder({8, 8, 8}, AxisOrder::yxz);
  builder.append_to(3, 1);
  builder.append_to(200, 0);
  builder.append_to(512, 300);
  return builder.finish();
}

RunChunk two_wide_runs() {
  RunBuilder builder({64, 64, 64}, AxisOrder::xyz);
  builder.append_to(70'000, 2);
  builder.append_to(262'144, 0);
  return builder.finish();
}

}  // namespace

TEST_CASE("raw chunk bytes are pinned", "[protocol][golden]") {
  check_bytes(three_runs(), ChunkEncoding::raw,
              "01 01 02 00  08 08 08 00  03000000"
              "0300 0100  c800 0000  0002 2c01");
}

TEST_CASE("raw chunk bytes of a large volume are pinned", "[protocol][golden]") {
  check_bytes(two_wide_runs(), ChunkEncoding::raw,
              "01 01 00 00  40 40 40 00  02000000"
              "70110100 00000400"  // ends
              "0200 0000");        // materials
}

TEST_CASE("packed chunk bytes are pinned", "[protocol][golden]") {
  check_bytes(three_runs(), ChunkEncoding::packed,
              "02 01 02  08 08 08  03"
              "03 00 00 aa02"  // palette: 0, 0 + 1 + 0, 1 + 1 + 298
              "01 00 02"       // palette indices
              "e7"             // of material 0: to the end of the 25th line
              "03");           // of material 1: length 3; the last run fills up
  check_bytes(two_wide_runs(), ChunkEncoding::packed,
              "02 01 00  40 40 40  02  02 00 01  01 00  00  f0a204");
  check_bytes(uniform_chunk(Extent::cube(32), 1), ChunkEncoding::packed,
              "02 01 00  20 20 20  01  01 01  00");
}

TEST_CASE("coded chunk bytes are pinned", "[protocol][golden]") {
  check_bytes(uniform_chunk(Extent::cube(32), 1), ChunkEncoding::coded,
              "03 01 00  20 20 20  01 01");
  check_bytes(three_runs(), ChunkEncoding::coded, "03 01 02  08 08 08  03 00 00 aa02  95fe3d9fa0");
  check_bytes(two_wide_runs(), ChunkEncoding::coded, "03 01 00  40 40 40  02 00 01  787d58bd");

  // Two surfaces that vary and meet, and a material that appears only in the last layers.
  RunBuilder builder({8, 8, 8}, AxisOrder::xzy);
  for (unsigned y = 0; y < 8; ++y) {
    for (unsigned z = 0; z < 8; ++z) {
      builder.append(2 + (y + z) / 4, 7);
      builder.append(1 + z % 2, 9);
      builder.append(5 - (y + z) / 4 - z % 2, y > 4 ? 11 : 0);
    }
  }
  check_bytes(builder.finish(), ChunkEncoding::coded,
              "03 01 01  08 08 08  04 00 06 01 01"
              "9a5de24ed70de1f5243995e01fbb7cda2ff879a919396b4917cfa6d834ae83d4d5cb1b6b");
}

TEST_CASE("a packed chunk under zstd still decodes", "[protocol][golden]") {
  // 64 times 40 voxels of material 1 and 24 of air. Other releases of zstd may make other bytes, so
  // only decoding is pinned.
  RunBuilder builder({16, 16, 16}, AxisOrder::zyx);
  for (int i = 0; i < 64; ++i) {
    builder.append(40, 1);
    builder.append(24, 0);
  }
  const auto decoded =
      decode_chunk(from_hex("02 01 0d  10 10 10  8001  02 00 00"
                            "20ff7d0000200100fe28030004920c27dd5deab0"));
  REQUIRE(decoded.has_value());
  CHECK(*decoded == builder.finish());
}

TEST_CASE("the chunk of the protocol page has its bytes in every encoding", "[protocol][golden]") {
  check_bytes(three_runs(), ChunkEncoding::raw, page_example("raw-chunk"));
  check_bytes(three_runs(), ChunkEncoding::packed, page_example("packed-chunk"));
  check_bytes(three_runs(), ChunkEncoding::coded, page_example("coded-chunk"));
}

}  // namespace runstone::test
