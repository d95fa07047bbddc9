#include "server/runtime/encoded_chunks.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

#include "tests/support/runs/random_chunk.hpp"

namespace runstone::test {
namespace {

constexpr ChunkKey kKey{0, {1, 2, 3}};

ChunkPtr some_chunk(SplitMix64& rng) {
  Chunk chunk;
  chunk.voxels = random_chunk(rng, Extent::cube(16), AxisOrder::xyz, 5, ChunkShape::speckled);
  chunk.version = {1, 1 + rng.below(1000)};
  chunk.digest = digest_of(chunk.voxels);
  return std::make_shared<const Chunk>(std::move(chunk));
}

}  // namespace

TEST_CASE("a chunk is encoded once in each encoding, and every call returns the same bytes",
          "[server]") {
  SplitMix64 rng{1};
  EncodedChunks chunks;
  const ChunkPtr chunk = some_chunk(rng);
  const ChunkEntry packed = chunks.snapshot(kKey, chunk, ChunkEncoding::packed);
  CHECK(*packed.bytes == *encode_snapshot(kKey, *chunk, ChunkEncoding::packed).bytes);
  CHECK(chunks.snapshot(kKey, chunk, ChunkEncoding::packed).bytes == packed.bytes);
  const ChunkEntry raw = chunks.snapshot(kKey, chunk, ChunkEncoding::raw);
  CHECK(*raw.bytes == *encode_snapshot(kKey, *chunk, ChunkEncoding::raw).bytes);
  const ChunkKey elsewhere{0, {1, 2, 4}};
  CHECK(*chunks.snapshot(elsewhere, chunk, ChunkEncoding::raw).bytes ==
        *encode_snapshot(elsewhere, *chunk, ChunkEncoding::raw).bytes);
  CHECK(chunks.encoded() == 3);
  CHECK(chunks.bytes() > packed.bytes->size() + raw.bytes->size());
}

TEST_CASE("a released chunk is not mistaken for another one at its address", "[server]") {
  SplitMix64 rng{2};
  EncodedChunks chunks;
  for (int i = 0; i < 200; ++i) {
    // This is not make_shared, because then a weak pointer would keep the address in use.
    const ChunkPtr chunk(new Chunk(*some_chunk(rng)));
    CHECK(*chunks.snapshot(kKey, chunk, ChunkEncoding::packed).bytes ==
          *encode_snapshot(kKey, *chunk, ChunkEncoding::packed).bytes);
  }
  CHECK(chunks.encoded() == 200);
}

TEST_CASE("the most recently used snapshots are kept, within the bound", "[server]") {
  SplitMix64 rng{3};
  std::vector<ChunkPtr> some;
  for (int i = 0; i < 50; ++i) some.push_back(some_chunk(rng));
  std::size_t largest = 0;
  for (const ChunkPtr& chunk : some) {
    largest = std::max(largest, encode_snapshot(kKey, *chunk, ChunkEncoding::raw).bytes->size());
  }
  EncodedChunks chunks(2 * largest);
  const ChunkEntry first = chunks.snapshot(kKey, some[0], ChunkEncoding::raw);
  for (const ChunkPtr& chunk : some) {
    chunks.snapshot(kKey, chunk, ChunkEncoding::raw);
    CHECK(chunks.snapshot(kKey, some[0], ChunkEncoding::raw).bytes == first.bytes);
    CHECK(chunks.bytes() <= 2 * largest);
  }
  CHECK(chunks.encoded() == 50);
  for (const ChunkPtr& chunk : some) chunks.snapshot(kKey, chunk, ChunkEncoding::raw);
  CHECK(chunks.encoded() > 90);  // most were evicted
}

TEST_CASE("threads that request a chunk at the same time wait for the one that encodes it",
          "[server]") {
  SplitMix64 rng{4};
  std::vector<ChunkPtr> some;
  for (int i = 0; i < 100; ++i) some.push_back(some_chunk(rng));
  EncodedChunks chunks;
  std::vector<std::vector<ChunkEntry>> got(4);
  std::vector<std::thread> threads;
  for (auto& mine : got) {
    threads.emplace_back([&] {
      for (const ChunkPtr& chunk : some)
        mine.push_back(chunks.snapshot(kKey, chunk, ChunkEncoding::coded));
    });
  }
  for (std::thread& thread : threads) thread.join();
  CHECK(chunks.encoded() == some.size());
  for (std::size_t i = 0; i < some.size(); ++i) {
    for (const auto& mine : got) CHECK(mine[i].bytes == got[0][i].bytes);
  }
}

}  // namespace runstone::test
