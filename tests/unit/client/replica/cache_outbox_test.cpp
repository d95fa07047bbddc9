#include "client/replica/cache_outbox.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

ChunkPtr chunk_at(Sequence seq) {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(16), 3);
  chunk.version = {1, seq};
  return std::make_shared<const Chunk>(std::move(chunk));
}

struct OutboxFixture {
  TrackedChunk& current(std::int32_t x, Sequence seq) {
    TrackedChunk& chunk = *table.track({0, {x, 0, 0}}).first;
    table.set_current(chunk, chunk_at(seq));
    return chunk;
  }
  ReplicaChunks table;
  CacheOutbox outbox;
};

}  // namespace

TEST_CASE_METHOD(OutboxFixture, "a chunk is handed to the cache once per version", "[replica]") {
  TrackedChunk& chunk = current(0, 1);
  current(1, 1);
  CHECK(outbox.take(&table, 1).size() == 1);
  CHECK(outbox.take(&table, 9).size() == 1);
  CHECK(outbox.take(&table, 9).empty());
  table.set_current(chunk, chunk_at(2));
  const auto again = outbox.take(&table, 9);
  REQUIRE(again.size() == 1);
  CHECK(again[0].first == chunk.key);
  CHECK(again[0].second->version.seq == 2);
}

TEST_CASE_METHOD(OutboxFixture, "only chunks that the server vouches for are handed over",
                 "[replica]") {
  table.set_confirmed(*table.track({0, {0, 0, 0}}).first, chunk_at(1));
  table.request(current(1, 1));
  CHECK(outbox.take(&table, 9).empty());
}

TEST_CASE_METHOD(OutboxFixture, "chunks that left the view are bounded in bytes", "[replica]") {
  outbox.enable();
  Chunk large = *chunk_at(1);
  large.voxels.runs.reserve(kCacheOutboxBytesMax / 4 / 4);  // a quarter, at 4 bytes a run
  TrackedChunk& chunk = *table.track({0, {0, 0, 0}}).first;
  table.set_current(chunk, std::make_shared<const Chunk>(std::move(large)));
  for (int i = 0; i < 5; ++i) outbox.add(chunk);
  CHECK(outbox.take(nullptr, 99).size() == 3);  // three, and what is kept beside the runs
  outbox.add(chunk);
  CHECK(outbox.take(nullptr, 99).size() == 1);
}

TEST_CASE_METHOD(OutboxFixture, "a batch of chunks in view is bounded in bytes", "[replica]") {
  Chunk large = *chunk_at(1);
  large.voxels.runs.reserve(kCacheBatchBytesMax / 4);
  table.set_current(*table.track({0, {0, 0, 0}}).first,
                    std::make_shared<const Chunk>(std::move(large)));
  current(1, 1);
  CHECK(outbox.take(&table, 9).size() == 1);
  CHECK(outbox.take(&table, 9).size() == 1);
  CHECK(outbox.take(&table, 9).empty());
}

TEST_CASE_METHOD(OutboxFixture,
                 "chunks that left the view come first, also while the past is shown",
                 "[replica]") {
  const TrackedChunk& left = current(5, 1);
  outbox.add(left);
  CHECK(outbox.take(nullptr, 9).empty());  // not enabled
  outbox.enable();
  outbox.add(left);
  current(0, 1);
  CHECK(outbox.take(nullptr, 9).size() == 1);
  outbox.add(left);
  const auto both = outbox.take(&table, 9);
  REQUIRE(both.size() == 3);
  CHECK(both[0].first == left.key);
  outbox.add(current(6, 1));
  outbox.clear();
  CHECK(outbox.take(nullptr, 9).empty());
}

TEST_CASE_METHOD(OutboxFixture, "chunks that change all the time are handed over once a round",
                 "[replica]") {
  const auto change_all = [this](Sequence seq) {
    for (std::int32_t x = 0; x < 8; ++x) current(x, seq);
  };
  for (Sequence round = 0; round < 3; ++round) {
    std::vector<ChunkKey> keys;
    for (Sequence call = 0; call < 4; ++call) {
      change_all(10 * round + call + 1);
      for (const auto& [key, chunk] : outbox.take(&table, 2)) keys.push_back(key);
      CHECK(outbox.is_round_over() == (call == 3));
    }
    REQUIRE(keys.size() == 8);
    for (std::int32_t x = 0; x < 8; ++x) CHECK(keys[static_cast<std::size_t>(x)].at.x == x);
  }
}

TEST_CASE_METHOD(OutboxFixture, "a round that finds no more chunks begins anew", "[replica]") {
  for (std::int32_t x = 0; x < 3; ++x) current(x, 1);
  CHECK(outbox.take(&table, 2).size() == 2);
  CHECK_FALSE(outbox.is_round_over());
  table.request(*table.find({0, {2, 0, 0}}));  // the server no longer vouches for it
  current(0, 2);
  CHECK(outbox.take(&table, 2).size() == 1);
  CHECK(outbox.is_round_over());
  CHECK(outbox.take(&table, 2).empty());
}

TEST_CASE_METHOD(OutboxFixture, "the past ends a round", "[replica]") {
  for (std::int32_t x = 0; x < 3; ++x) current(x, 1);
  CHECK(outbox.take(&table, 2).size() == 2);
  CHECK(outbox.take(nullptr, 2).empty());
  CHECK(outbox.is_round_over());
  CHECK(outbox.take(&table, 2).size() == 1);
}
