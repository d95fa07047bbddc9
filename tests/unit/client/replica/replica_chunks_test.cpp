#include "client/replica/replica_chunks.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

namespace {

const ChunkKey kKey{0, {1, 2, 3}};

ChunkPtr some_chunk() {
  Chunk chunk;
  chunk.voxels = uniform_chunk(Extent::cube(16), 3);
  return std::make_shared<const Chunk>(std::move(chunk));
}

/// The counts by state, found by walking all chunks.
std::array<std::size_t, kChunkStateCount> walked(const ReplicaChunks& table) {
  std::array<std::size_t, kChunkStateCount> counts{};
  for (const auto& [key, chunk] : table) ++counts[static_cast<std::size_t>(chunk.state())];
  return counts;
}

}  // namespace

TEST_CASE("an answer makes a chunk current, and leaves a request open", "[replica]") {
  CHECK(after_answer(ChunkState::expected) == ChunkState::current);
  CHECK(after_answer(ChunkState::requested) == ChunkState::repairing);
  CHECK(after_answer(ChunkState::current) == ChunkState::current);
  CHECK(after_answer(ChunkState::repairing) == ChunkState::repairing);
  CHECK(after_answer(ChunkState::unavailable) == ChunkState::current);
}

TEST_CASE("a request remembers whether the server has vouched for the chunk", "[replica]") {
  CHECK(after_request(ChunkState::expected) == ChunkState::requested);
  CHECK(after_request(ChunkState::requested) == ChunkState::requested);
  CHECK(after_request(ChunkState::current) == ChunkState::repairing);
  CHECK(after_request(ChunkState::repairing) == ChunkState::repairing);
}

TEST_CASE("a chunk is made once and found by its key", "[replica]") {
  ReplicaChunks table;
  CHECK(table.find(kKey) == nullptr);
  const auto [chunk, is_new] = table.track(kKey);
  CHECK(is_new);
  CHECK(chunk->key == kKey);
  CHECK(chunk->state() == ChunkState::expected);
  CHECK(table.find(kKey) == chunk);
  const auto [again, is_new_again] = table.track(kKey);
  CHECK_FALSE(is_new_again);
  CHECK(again == chunk);
}

TEST_CASE("a snapshot ends a request, and an unavailable chunk holds nothing", "[replica]") {
  ReplicaChunks table;
  TrackedChunk& chunk = *table.track(kKey).first;
  table.request(chunk);
  CHECK(table.awaiting().contains(kKey));
  CHECK(table.vouched_count() == 0);
  table.answer(chunk);
  CHECK(table.awaiting().contains(kKey));
  CHECK(table.vouched_count() == 1);
  table.set_current(chunk, some_chunk());
  CHECK(chunk.is_current());
  CHECK(table.awaiting().empty());
  CHECK(table.confirmed_count() == 1);

  chunk.inbox.push_back({});
  table.set_unavailable(chunk);
  CHECK(chunk.is_unavailable());
  CHECK(chunk.confirmed() == nullptr);
  CHECK(chunk.inbox.empty());
  CHECK(table.confirmed_count() == 0);
  CHECK(table.count(ChunkState::unavailable) == 1);
}

TEST_CASE("runs that are confirmed and shown count once", "[replica]") {
  TrackedChunk chunk(kKey);
  const std::size_t empty = chunk.bytes();
  ReplicaChunks table;
  TrackedChunk& tracked = *table.track(kKey).first;
  CHECK(table.bytes() == empty);
  table.set_current(tracked, some_chunk());
  const std::size_t confirmed = table.bytes();
  CHECK(confirmed > empty);
  tracked.shown = {tracked.confirmed(), &tracked.confirmed()->voxels};
  table.recount(tracked);
  CHECK(table.bytes() == confirmed);
  tracked.shown = std::make_shared<const RunChunk>(tracked.confirmed()->voxels);
  table.recount(tracked);
  CHECK(table.bytes() > confirmed);
}

TEST_CASE("counts by state equal those of a walk after any transitions", "[replica]") {
  ReplicaChunks table;
  std::uint32_t random = 7;
  const auto draw = [&random](std::uint32_t below) {
    random = random * 1'664'525 + 1'013'904'223;
    return (random >> 16) % below;
  };
  for (int step = 0; step < 4000; ++step) {
    const ChunkKey key{0, {static_cast<std::int32_t>(draw(12)), 0, 0}};
    TrackedChunk& chunk = *table.track(key).first;
    switch (draw(7)) {
      case 0:
        table.answer(chunk);
        break;
      case 1:
        if (!chunk.is_unavailable()) table.request(chunk);
        break;
      case 2:
        table.set_current(chunk, some_chunk());
        break;
      case 3:
        table.set_unavailable(chunk);
        break;
      case 4:
        table.expect(chunk);
        break;
      case 5:
        table.set_confirmed(chunk, draw(2) == 0 ? nullptr : some_chunk());
        break;
      default:
        table.erase_if([&key](const TrackedChunk& c) { return c.key == key; });
    }
    const auto counts = walked(table);
    std::size_t confirmed = 0, bytes = 0;
    std::set<ChunkKey> awaiting;
    for (const auto& [at, each] : table) {
      confirmed += each.confirmed() ? 1 : 0;
      bytes += each.bytes();
      if (is_awaiting(each.state())) awaiting.insert(at);
    }
    CAPTURE(step);
    for (std::size_t i = 0; i < kChunkStateCount; ++i) {
      REQUIRE(table.count(static_cast<ChunkState>(i)) == counts[i]);
    }
    REQUIRE(table.confirmed_count() == confirmed);
    REQUIRE(table.bytes() == bytes);
    REQUIRE(table.awaiting() == awaiting);
  }
  table.clear();
  for (std::size_t i = 0; i < kChunkStateCount; ++i) {
    CHECK(table.count(static_cast<ChunkState>(i)) == 0);
  }
  CHECK(table.confirmed_count() == 0);
  CHECK(table.bytes() == 0);
  CHECK(table.awaiting().empty());
}
