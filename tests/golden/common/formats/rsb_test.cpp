// The bytes of .rsb version 1, as docs/builds.md specifies them. A change here is a new version.
#include <catch2/catch.hpp>

#include "tests/support/core/hex.hpp"
#include "tests/support/formats/rsb_bytes.hpp"

namespace runstone::test {
namespace {

SampleBuild golden_build() {
  SampleBuild build;
  build.info = sample_build_info({70, 3, 2});
  build.materials = sample_build_materials(3);
  RunChunk cells = uniform_chunk({64, 3, 2}, 0);
  fill(cells, 5, 100, 1);
  fill(cells, 110, 1, 3);
  build.sections.push_back({{0, 0, 0}, cells});
  build.sections.push_back({{1, 0, 0}, uniform_chunk({6, 3, 2}, 2)});
  return build;
}

const Bytes& golden_plain_rsb() {
  static const Bytes kBytes = from_hex(
      // mark, version 1
      "89 52 53 42 46 0d 0a 1a 01 00 00 00 "
      // block at 12: kind head, stored 48, raw 48, count 0
      "01 00 00 00 30 00 00 00 30 00 00 00 00 00 00 00 "
      // first 0, position 12
      "00 00 00 00 00 00 00 00 0c 00 00 00 00 00 00 00 "
      // checksum of the payload, checksum of the header
      "7d 50 47 8f d9 7c 19 a7 ab 2a ad ea d8 3c 74 80 "
      // sides 70, 3, 2
      "45 02 01 "
      // origin -5, 64, 300
      "09 80 01 d8 04 "
      // created
      "80 80 f9 c0 c1 c4 82 03 "
      // "Muehle am Bach" with two dots on the u
      "0e 4d c3 bc 68 6c 65 20 61 6d 20 42 61 63 68 "
      // author "zoe" with two dots
      "04 7a 6f c3 ab "
      // two tags: "mill", "wood"
      "02 04 6d 69 6c 6c 04 77 6f 6f 64 "
      // three materials
      "02 "
      // block at 108: kind materials, stored 56, raw 56, count 3
      "02 00 00 00 38 00 00 00 38 00 00 00 03 00 00 00 "
      // first 0, position 108, checksums
      "00 00 00 00 00 00 00 00 6c 00 00 00 00 00 00 00 "
      "64 17 1f 3a df ae 0b 6b 4e df 18 2b e0 b3 05 b7 "
      // "m00000", no states, colour, opaque and solid
      "06 6d 30 30 30 30 30 00 00 02 03 ff 01 "
      // "m00000", "facing=north", colour, transparent and liquid
      "06 6d 30 30 30 30 30 0c 66 61 63 69 6e 67 3d 6e 6f 72 74 68 01 02 03 5a 06 "
      // "m00001", no states, colour, opaque and solid with a look: 1, 2, 3, 4, bricks
      "06 6d 30 30 30 30 31 00 02 02 03 ff 11 01 02 03 04 02 "
      // block at 212: kind sections, stored 18, raw 18, count 2
      "03 00 00 00 12 00 00 00 12 00 00 00 02 00 00 00 "
      // first 0, position 212, checksums
      "00 00 00 00 00 00 00 00 d4 00 00 00 00 00 00 00 "
      "04 6a 9a cb ee da 03 50 10 98 e7 5b 98 ae 0a e6 "
      // section 0: order xyz, three numbers: 0, 1, 3
      "00 00 02 00 00 01 "
      // 5 untouched, 100 of number 1, 5 untouched, 1 of number 3, 273 untouched
      "0c c6 01 08 01 a0 04 "
      // section 1: order xyz, one number: 2; 36 cells
      "00 00 00 02 23 "
      // block at 278: kind end, stored 3, raw 3, count 0
      "04 00 00 00 03 00 00 00 03 00 00 00 00 00 00 00 "
      // first 0, position 278, checksums
      "00 00 00 00 00 00 00 00 16 01 00 00 00 00 00 00 "
      "e0 a7 8a 86 3c 1f b5 3c 40 69 ba b9 b6 ae e5 b0 "
      // two sections, 137 touched cells
      "02 89 01 ");
  return kBytes;
}

/// A section with 200 stretches of 20 cells, compressed by zstd 1.5 at level 9. Another zstd may
/// compress differently, but must decompress these bytes.
const Bytes& golden_packed_rsb() {
  static const Bytes kBytes = from_hex(
      "89 52 53 42 46 0d 0a 1a 01 00 00 00 01 00 00 00 30 00 00 00 30 00 00 00 "
      "00 00 00 00 00 00 00 00 00 00 00 00 0c 00 00 00 00 00 00 00 25 99 0d cf "
      "4d fd 35 90 a4 e6 79 5d 32 e1 bd dc 3f 3f 3f 09 80 01 d8 04 80 80 f9 c0 "
      "c1 c4 82 03 0e 4d c3 bc 68 6c 65 20 61 6d 20 42 61 63 68 04 7a 6f c3 ab "
      "02 04 6d 69 6c 6c 04 77 6f 6f 64 02 02 00 00 00 38 00 00 00 38 00 00 00 "
      "03 00 00 00 00 00 00 00 00 00 00 00 6c 00 00 00 00 00 00 00 64 17 1f 3a "
      "df ae 0b 6b f7 42 e4 f6 3b c3 e6 3f 06 6d 30 30 30 30 30 00 00 02 03 ff "
      "01 06 6d 30 30 30 30 30 0c 66 61 63 69 6e 67 3d 6e 6f 72 74 68 01 02 03 "
      "5a 06 06 6d 30 30 30 30 31 00 02 02 03 ff 11 01 02 03 04 02 03 00 00 00 "
      "25 00 00 00 60 02 00 00 01 00 00 00 00 00 00 00 00 00 00 00 d4 00 00 00 "
      "00 00 00 00 9c 22 f7 16 52 46 18 56 19 81 d4 02 52 b9 7a 78 28 b5 2f fd "
      "60 60 01 dd 00 00 a0 00 00 03 00 00 00 00 4d c5 06 3a c5 06 3b c5 06 39 "
      "a5 88 25 01 00 93 b0 2a 4b 04 00 00 00 03 00 00 00 03 00 00 00 00 00 00 "
      "00 00 00 00 00 00 00 00 00 29 01 00 00 00 00 00 00 8e 8e 87 7b 1e c2 ee "
      "44 42 3b 0d f4 2b 9d 66 ea 01 a0 1f ");
  return kBytes;
}

}  // namespace

TEST_CASE("the bytes of an .rsb whose blocks are not packed are pinned", "[rsb][golden]") {
  const SampleBuild build = golden_build();
  CHECK(rsb_of(build, 0) == golden_plain_rsb());
  const RsbContents read = read_rsb(golden_plain_rsb());
  if (read.error) FAIL(read.error->message());
  CHECK(read.build.info == build.info);
  CHECK(read.build.materials == build.materials);
  CHECK(read.build.sections == build.sections);
}

TEST_CASE("a packed .rsb of version 1 can be read", "[rsb][golden]") {
  const RsbContents read = read_rsb(golden_packed_rsb());
  if (read.error) FAIL(read.error->message());
  CHECK(read.build.info == sample_build_info({64, 64, 64}));
  RunChunk cells = uniform_chunk(Extent::cube(64), 0);
  for (std::uint32_t i = 0; i < 200; ++i)
    fill(cells, i * 300, 20, static_cast<Material>(i % 3 + 1));
  REQUIRE(read.build.sections.size() == 1);
  CHECK(read.build.sections[0].cells == cells);
}

}  // namespace runstone::test
