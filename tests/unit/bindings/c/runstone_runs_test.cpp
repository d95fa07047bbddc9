#include "bindings/c/runstone_runs.h"

#include <catch2/catch.hpp>
#include <vector>

#include "common/core/hash.hpp"
#include "common/runs/dense.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "tests/support/runs/dense_chunk.hpp"
#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {

TEST_CASE("the header for raw chunks reads what the codec writes", "[c_interface]") {
  SplitMix64 rng{61};
  for (int round = 0; round < 40; ++round) {
    CAPTURE(round);
    // One of eight has more than 65,535 voxels, and so the wide form.
    const RunChunk chunk = round % 8 == 0 ? random_chunk(rng, {48, 40, 40}, random_order(rng), 5)
                                          : random_chunk(rng, 24, 5);
    const Bytes bytes = encode_chunk(chunk, ChunkEncoding::raw);
    runstone_runs runs{};
    REQUIRE(runstone_runs_open(&runs, bytes.data(), bytes.size()) == RUNSTONE_RUNS_OK);
    REQUIRE(runs.count == chunk.runs.size());
    CHECK(runs.is_wide == (chunk.runs.is_narrow() ? 0U : 1U));
    bool same = true;
    for (std::uint32_t i = 0; i < runs.count; ++i) {
      same = same && runstone_runs_end(&runs, i) == chunk.runs.end(i) &&
             runstone_runs_material(&runs, i) == chunk.runs.material(i);
    }
    const DenseChunk dense = DenseChunk::of(chunk);
    for (int i = 0; i < 200; ++i) {
      const auto x = rng.below(chunk.extent.x), y = rng.below(chunk.extent.y),
                 z = rng.below(chunk.extent.z);
      same =
          same && runstone_runs_at(&runs, static_cast<std::uint32_t>(x),
                                   static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z)) ==
                      dense.at(static_cast<int>(x), static_cast<int>(y), static_cast<int>(z));
    }
    std::vector<std::uint16_t> voxels(runs.volume);
    runstone_runs_to_array(&runs, voxels.data());
    CHECK(same);
    CHECK(voxels == to_dense(chunk));
  }
}

TEST_CASE("the header for raw chunks refuses what the codec refuses", "[c_interface]") {
  SplitMix64 rng{62};
  const RunChunk chunk = random_chunk(rng, {8, 9, 10}, AxisOrder::yxz, 4, ChunkShape::boxes);
  const Bytes bytes = encode_chunk(chunk, ChunkEncoding::raw);
  const auto opened = [](const Bytes& in) {
    runstone_runs runs{};
    return runstone_runs_open(&runs, in.data(), in.size());
  };
  for (std::size_t size = 0; size < bytes.size(); ++size)
    CHECK(opened({bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)}) !=
          RUNSTONE_RUNS_OK);
  Bytes longer = bytes;
  longer.push_back(0);
  CHECK(opened(longer) == RUNSTONE_RUNS_WRONG_SIZE);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      Bytes flipped = bytes;
      flipped[at] = static_cast<std::uint8_t>(flipped[at] ^ 1U << bit);
      CAPTURE(at, bit);
      // Another material can be right; the codec says so, too.
      const auto decoded = decode_chunk(flipped);
      const bool is_raw = flipped[0] == 1;
      CHECK((opened(flipped) == RUNSTONE_RUNS_OK) == (is_raw && decoded.has_value()));
    }
  }
  for (const auto encoding : {ChunkEncoding::packed, ChunkEncoding::coded})
    CHECK(opened(encode_chunk(chunk, encoding)) == RUNSTONE_RUNS_NOT_RAW);
  const Bytes shortest = encode_chunk(uniform_chunk(Extent::cube(16), 1), ChunkEncoding::packed);
  REQUIRE(shortest.size() < 12);
  CHECK(opened(shortest) == RUNSTONE_RUNS_NOT_RAW);
  runstone_runs runs{};
  CHECK(runstone_runs_open(&runs, nullptr, 0) == RUNSTONE_RUNS_WRONG_SIZE);
}

}  // namespace runstone::test
