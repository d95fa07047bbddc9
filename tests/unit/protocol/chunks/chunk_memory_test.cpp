// Tests of what the chunk codec allocates.
#include <catch2/catch.hpp>

#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/codec/packed_spelling.hpp"
#include "tests/support/core/count_allocations.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

/// Keeps an allocation that clang would otherwise remove.
const void* volatile looked_at = nullptr;

Allocations cost_of_refusing(const Bytes& bytes) {
  return allocations_of([&] { REQUIRE_FALSE(decode_chunk(bytes).has_value()); });
}

}  // namespace

TEST_CASE("the counter of allocations counts", "[protocol]") {
  const Allocations cost = allocations_of([] {
    const Bytes bytes(1000, std::uint8_t{1});
    looked_at = bytes.data();
  });
  CHECK(looked_at != nullptr);
  CHECK(cost.count == 1);
  CHECK(cost.bytes >= 1000);
}

TEST_CASE("a count without the bytes for it allocates almost nothing", "[protocol]") {
  static_cast<void>(encode_chunk(uniform_chunk(Extent::cube(16), 1),
                                 ChunkEncoding::packed));        // fills the scratch of the thread
  Bytes raw{1, 1, 0, 0, 128, 128, 128, 0, 0xff, 0xff, 0x1f, 0};  // counts 2,097,151 runs, has none
  CHECK(cost_of_refusing(raw).bytes < 10'000);
  PackedSpelling packed;
  packed.sides = {128, 128, 128};
  packed.runs = 128 * 128 * 128;
  CHECK(cost_of_refusing(packed.bytes()).bytes < 10'000);
  packed.palette_size = 65'536;  // has three
  CHECK(cost_of_refusing(packed.bytes()).bytes < 10'000);
  packed = {};
  packed.order |= 8;
  packed.stored = Bytes{0xe0, 0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0};  // announces 2^40 bytes, has none
  CHECK(cost_of_refusing(packed.bytes()).bytes < 10'000);
}

TEST_CASE("a zstd bomb allocates what its run count allows, whatever its content size",
          "[protocol]") {
  PackedSpelling bomb;
  bomb.order = 8;
  bomb.runs = 512;
  bomb.palette = {0};
  bomb.stored = zstd_frame(Bytes(64 << 20, std::uint8_t{0}));
  REQUIRE(bomb.stored->size() < 10'000);
  CHECK(cost_of_refusing(bomb.bytes()).bytes < 10'000);

  // The worst body whose announced sizes are accepted: every voxel is a run. It is refused when the
  // runs exceed the volume.
  bomb.sides = {128, 128, 128};
  bomb.runs = 128 * 128 * 128;
  // The indices, then a token for each run but the last: to the end of the line, so the runs exceed
  // the volume.
  Bytes body(bomb.runs, std::uint8_t{0});
  body.resize(2 * bomb.runs - 1, std::uint8_t{255});
  bomb.stored = zstd_frame(body);
  REQUIRE(bomb.bytes().size() < 1'000);
  CHECK(cost_of_refusing(bomb.bytes()).bytes < 11ULL * 128 * 128 * 128);
  // With a smaller extent expected, decoding does not start.
  const Allocations small = allocations_of(
      [&] { REQUIRE_FALSE(decode_chunk(bomb.bytes(), Extent::cube(32)).has_value()); });
  CHECK(small.bytes < 10'000);
}

TEST_CASE("after the first chunks the codec allocates only the decoded chunk", "[protocol]") {
  SplitMix64 rng{3};
  const RunChunk chunk = random_chunk(rng, Extent::cube(32), AxisOrder::xyz, 40, ChunkShape::boxes);
  for (const ChunkEncoding encoding :
       {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    Bytes out;
    encode_chunk(chunk, encoding, out);
    static_cast<void>(decode_chunk(out));
    const Bytes bytes = out;
    const Allocations encoding_cost = allocations_of([&] {
      out.clear();
      encode_chunk(chunk, encoding, out);
    });
    CHECK(encoding_cost.count == 0);
    const Allocations decoding_cost =
        allocations_of([&] { REQUIRE(decode_chunk(bytes).has_value()); });
    CHECK(decoding_cost.count <=
          (encoding == ChunkEncoding::raw ? 1 : 2));  // the runs, and the palette
  }
}

}  // namespace runstone::test
