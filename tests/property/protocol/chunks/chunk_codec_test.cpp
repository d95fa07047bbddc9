#include <catch2/catch.hpp>

#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("a chunk comes back from all encodings, run for run", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed()};
  for (int step = 0; step < 400; ++step) {
    CAPTURE(Catch::rngSeed(), step);
    const RunChunk chunk = random_chunk(rng);
    const Bytes raw = encode_chunk(chunk, ChunkEncoding::raw);
    const Bytes packed = encode_chunk(chunk, ChunkEncoding::packed);
    CHECK(raw.size() == raw_bytes(chunk));
    const auto from_coded = decode_chunk(encode_chunk(chunk, ChunkEncoding::coded), chunk.extent);
    REQUIRE(from_coded.has_value());
    REQUIRE(*from_coded == chunk);
    const auto from_raw = decode_chunk(raw);
    const auto from_packed = decode_chunk(packed, chunk.extent);
    REQUIRE(from_raw.has_value());
    REQUIRE(from_packed.has_value());
    REQUIRE(*from_raw == chunk);
    REQUIRE(*from_packed == chunk);
    REQUIRE(DenseChunk::of(*from_packed) == DenseChunk::of(chunk));
  }
}

TEST_CASE("packed is larger than raw by its palette at most", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 1};
  for (int step = 0; step < 100; ++step) {
    const RunChunk chunk = random_chunk(rng);
    // Worst case: every run has another material (3 bytes in the palette, 2 in the plane) and a
    // length of 3 bytes.
    CHECK(encode_chunk(chunk, ChunkEncoding::packed).size() <= 20 + 8 * chunk.runs.size());
  }
}

TEST_CASE("no truncation and no extra byte decodes to the same chunk", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 2};
  for (int step = 0; step < 30; ++step) {
    const RunChunk chunk = random_chunk(rng, 16, 1 + rng.below(6));
    for (const ChunkEncoding encoding :
         {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
      const Bytes bytes = encode_chunk(chunk, encoding);
      const std::size_t stride = 1 + bytes.size() / 500;
      for (std::size_t size = 0; size < bytes.size(); size += stride) {
        CAPTURE(Catch::rngSeed(), step, size);
        const Bytes cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
        const auto decoded = decode_chunk(cut);
        if (encoding != ChunkEncoding::coded) REQUIRE_FALSE(decoded.has_value());
        // Coded bodies do not count runs: a truncated body may be the spelling of other runs.
        if (decoded) REQUIRE(encode_chunk(*decoded, encoding) == cut);
      }
      for (const int extra : {0, 1, 0x28, 0xff}) {
        Bytes longer = bytes;
        longer.push_back(static_cast<std::uint8_t>(extra));
        REQUIRE_FALSE(decode_chunk(longer).has_value());
      }
    }
  }
}

TEST_CASE("a flipped byte of a chunk gives an error or a valid chunk", "[protocol][property]") {
  SplitMix64 rng{Catch::rngSeed() + 3};
  for (int step = 0; step < 40; ++step) {
    const RunChunk chunk = random_chunk(rng, 16, 1 + rng.below(300));
    for (const ChunkEncoding encoding :
         {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
      Bytes bytes = encode_chunk(chunk, encoding);
      const std::size_t stride = 1 + bytes.size() / 300;
      for (std::size_t at = 0; at < bytes.size(); at += stride) {
        CAPTURE(Catch::rngSeed(), step, at);
        const std::uint8_t before = bytes[at];
        for (const unsigned flip : {0x01u, 0x08u, 0x80u, 0xffu}) {
          bytes[at] = static_cast<std::uint8_t>(before ^ flip);
          const auto decoded = decode_chunk(bytes);
          if (!decoded) continue;
          REQUIRE(validate(*decoded).has_value());
          // Raw and coded bytes have one spelling; packed ones may be compressed or not.
          if (encoding != ChunkEncoding::packed) REQUIRE(encode_chunk(*decoded, encoding) == bytes);
          REQUIRE(decode_chunk(encode_chunk(*decoded, encoding)).value() == *decoded);
        }
        bytes[at] = before;
      }
    }
  }
}

}  // namespace runstone::test
