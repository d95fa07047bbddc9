// The bounds of the memory that the data of a world take.
#include "server/world/order/world_memory.hpp"

#include <malloc.h>

#include <catch2/catch.hpp>
#include <memory>

#include "common/runs/run_builder.hpp"
#include "server/world/order/world_chunks.hpp"
#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

constexpr std::size_t kNoBound = std::size_t{1} << 40;

/// Returns a paste of one row of cells that alternate, so that each is a run of its own.
EditShape row_paste(VoxelPos at) {
  RunBuilder cells({60, 1, 1}, AxisOrder::xzy);
  for (int i = 0; i < 60; ++i) cells.append(1, static_cast<Material>(1 + i % 2));
  return Paste{at, *Clipboard::of({1, 2}, cells.finish()), {}};
}

WorldConfig with_memory(std::size_t views, std::size_t edits) {
  WorldConfig c = config();
  c.memory = {kNoBound, views, edits, kNoBound, kNoBound};
  return c;
}

}  // namespace

TEST_CASE("resident chunks count what the heap gives for them", "[world]") {
  constexpr std::int32_t kSide = 100;
  const std::size_t before = ::mallinfo2().uordblks;
  auto chunks = std::make_unique<WorldChunks>(kEdge);
  for (std::int32_t x = 0; x < kSide; ++x) {
    for (std::int32_t z = 0; z < kSide; ++z) {
      const ChunkKey key{0, {x, 0, z}};
      REQUIRE(chunks->begin_load(key));
      Chunk chunk;
      chunk.voxels = uniform_chunk({kEdge, kEdge, kEdge}, kEmpty, AxisOrder::xzy);
      chunk.voxels.runs.shrink_to_fit();
      REQUIRE(chunks->loaded(key, std::move(chunk)).has_value());
      chunks->released(key);
    }
  }
  const std::size_t taken = ::mallinfo2().uordblks - before;
  if (taken == 0) return;  // a sanitizer's heap does not count
  CAPTURE(taken, chunks->resident_bytes());
  CHECK(static_cast<double>(chunks->resident_bytes()) > 0.95 * static_cast<double>(taken));
  CHECK(static_cast<double>(chunks->resident_bytes()) < 1.1 * static_cast<double>(taken));
}

TEST_CASE("what an edited chunk keeps in memory counts, and leaves with it", "[world]") {
  WorldChunks chunks(kEdge);
  const ChunkKey key{0, {0, 0, 0}};
  REQUIRE(chunks.begin_load(key));
  Chunk chunk;
  chunk.voxels = uniform_chunk({kEdge, kEdge, kEdge}, kEmpty, AxisOrder::xzy);
  REQUIRE(chunks.loaded(key, std::move(chunk)).has_value());
  const std::size_t loaded = chunks.resident_bytes();
  chunks.push(key, {1, 1}, {SetVoxel{{1, 1, 1}}, {}, 1}, sizeof(EditDescriptor));
  chunks.publish(key);
  CHECK(chunks.stack_bytes() == 0);
  CHECK(chunks.resident_bytes() >= loaded + sizeof(EditDescriptor));
  chunks.mark_saved(key, {1, 1});
  chunks.released(key);
  chunks.evict(0, 10, [](const ChunkKey&) { return false; });
  CHECK(chunks.resident_count() == 0);
  CHECK(chunks.resident_bytes() == 0);
}

TEST_CASE("the edits of a chunk that is not in memory count until it is loaded", "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  CHECK(bench.server.order().memory().queued > 0);
  bench.server.commit(bench.now());
  CHECK(bench.server.order().memory().queued == 0);
  const std::size_t one = bench.server.order().memory().stacked;
  CHECK(one > sizeof(EditDescriptor));
  bench.edit(1, 2, kAtOrigin);
  bench.server.commit(bench.now());
  const std::size_t two = bench.server.order().memory().stacked;
  CHECK(two > one);
  CHECK(two < 2 * one);  // the stack itself counts once
  bench.view(1, kSmall);
  CHECK(bench.server.order().memory().stacked == 0);
  CHECK(bench.server.order().memory().voxels > 0);
  bench.edit(1, 3, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.server.order().memory().stacked == 0);
}

TEST_CASE("the clipboard of a paste counts once, over all the chunks that it touches", "[world]") {
  const EditDescriptor paste{row_paste({1, 1, 1}), {}, kEmpty};  // touches four chunks
  const std::size_t clipboard = std::get<Paste>(paste.shape).clipboard->memory_bytes();
  WorldBench bench;
  bench.join(1, 1);
  for (std::int32_t x = 0; x < 4; ++x)
    bench.edit(1, static_cast<ClientSequence>(x + 1), SetVoxel{{x * kEdge, 1, 1}});
  bench.server.commit(bench.now());
  const std::size_t before = bench.server.order().memory().stacked;
  bench.server.received(1, EditRequest{5, 0, paste}, bench.now());
  bench.server.commit(bench.now());
  const std::size_t added = bench.server.order().memory().stacked - before;
  const std::size_t copies = 4 * (sizeof(EditDescriptor) + sizeof(Sequence));
  CHECK(added <= clipboard + copies);
  CHECK(added + 4 > clipboard + copies);
}

TEST_CASE("over the bound edits are rejected busy with the reason, and accepted when there is room",
          "[world]") {
  WorldBench bench(with_memory(kNoBound, 100'000));
  bench.join(1, 1);
  bench.environment.log_bytes = 100'001;
  bench.edit(1, 1, kAtOrigin);
  CHECK(
      bench.environment.messages<Reject>(1, kEdge) ==
      std::vector<Reject>{{1, RejectReason::busy, "the server's memory is full (memory_mib)", 0}});
  const std::vector<EditOffer> offers = {{{1, 99, 1}, Cause::rollback, 0, {kAtOrigin, {}, 2}, 0}};
  const auto refused = bench.server.changes().order_edits(offers, 0, bench.now());
  CHECK(refused.state == ServerEditsResult::State::busy);
  CHECK(std::string(refused.reason) == "the server's memory is full (memory_mib)");
  bench.environment.log_bytes = 0;
  bench.edit(1, 2, kAtOrigin);
  CHECK(bench.server.changes().order_edits(offers, 0, bench.now()).count == 1);
  CHECK(bench.environment.records.size() == 2);
}

TEST_CASE("edits to chunks that are not in memory cannot take more than the bound", "[world]") {
  WorldBench bench(with_memory(kNoBound, 50'000));
  bench.join(1, 1);
  for (std::int32_t x = 0; x < 1'000; ++x) {
    bench.edit(1, static_cast<ClientSequence>(x + 1), SetVoxel{{x * kEdge, 1, 1}});
    bench.server.commit(bench.now());
  }
  CHECK(bench.environment.records.size() > 50);
  CHECK(bench.environment.records.size() < 300);
  CHECK(bench.server.order().memory().total() < 51'000);
}

TEST_CASE("without memory a session waits for its chunks, and the world still loads its own",
          "[world]") {
  WorldConfig c = with_memory(50'000, kNoBound);
  c.stack_load_edits = 1;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.environment.log_bytes = 50'001;
  bench.view(1, kSmall);
  CHECK(bench.environment.loads.empty());
  bench.tick();
  REQUIRE_FALSE(bench.environment.lines.empty());
  CHECK(bench.environment.lines.back().find("MEMORY: memory_mib is used up") == 0);

  bench.edit(1, 1, SetVoxel{{100, 1, 1}});
  bench.edit(1, 2, SetVoxel{{100, 1, 1}});
  bench.tick();
  CHECK(bench.environment.loads == std::deque<ChunkKey>{{0, {6, 0, 0}}});  // its stack is long
  bench.answer_loads();
  CHECK(bench.environment.snapshots.empty());

  bench.environment.log_bytes = 0;
  bench.tick();
  CHECK(bench.environment.lines.back() == "MEMORY: there is room again");
  bench.answer_loads();
  CHECK(bench.environment.snapshots.size() == 5);
}

TEST_CASE("an address that sees much leaves memory for others", "[world]") {
  constexpr AddressBlock kHog{1}, kOther{2};
  constexpr std::size_t kBound = 40'000;
  WorldConfig c = with_memory(kBound, kNoBound);
  c.memory.idle_bytes_max = 0;
  WorldBench bench(c);
  bench.join(1, 1, 1, kHog);
  bench.join(2, 2, 1, kHog);
  const auto look = [&](SessionId session, std::int32_t x) {
    bench.send_view(session, {1, {x, 0, 0}, 4, 2});
    for (int i = 0; i < 300; ++i) {
      bench.tick();
      if (bench.environment.loads.empty()) continue;
      const ChunkKey key = bench.environment.loads.front();
      bench.environment.loads.pop_front();
      bench.server.chunk_loaded(key, dotted_chunk(kEdge), bench.now());
    }
  };
  look(1, 0);
  look(2, 1'000);
  const std::size_t seen = bench.server.order().memory().voxels;
  CHECK(seen > kBound / 2);
  CHECK(seen < kBound * 3 / 4);  // two thirds for one address
  CHECK(bench.environment.loads.empty());

  const auto sent = [&](SessionId session) {
    return std::ranges::count(bench.environment.snapshots, session,
                              &FakeEnvironment::SentSnapshot::session);
  };
  const auto before = sent(1) + sent(2);
  bench.join(3, 3, 1, kOther);
  look(3, 2'000);
  CHECK(sent(3) > 5);
  CHECK(sent(1) + sent(2) == before);
  CHECK(bench.server.order().memory().voxels < kBound);
}

TEST_CASE("edits that wait make chunks without users leave memory", "[world]") {
  WorldConfig c = config();
  c.memory = {20'000, kNoBound, kNoBound, kNoBound, kNoBound};
  WorldBench bench(c);
  bench.join(1, 1);
  bench.view(1, kSmall);
  bench.send_view(1, {2, {1000, 0, 0}, 1, 0});
  bench.tick();
  const std::size_t resident = bench.server.order().chunks().resident_count();
  CHECK(resident >= 5);
  bench.environment.log_bytes = 20'000;
  bench.tick();
  CHECK(bench.server.order().chunks().resident_count() == resident - 5);
}

TEST_CASE("chunks that nobody sees any more take little memory, those in sight stay", "[world]") {
  WorldConfig c = with_memory(kNoBound, kNoBound);
  c.memory.unused_bytes_max = 0;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.view(1, kSmall);
  const std::size_t seen = bench.server.order().chunks().resident_count();
  REQUIRE(seen == 5);
  for (std::int32_t x = 1; x <= 20; ++x) {
    bench.send_view(1, {static_cast<std::uint32_t>(1 + x), {100 * x, 0, 0}, 1, 0});
    for (int i = 0; i < 5; ++i) {
      bench.tick();
      bench.answer_loads();
    }
    CHECK(bench.server.order().chunks().resident_count() <= 2 * seen);
  }
  bench.tick();
  CHECK(bench.server.order().chunks().resident_count() == seen);
}

TEST_CASE("many edits that wait for their chunks begin a round of snapshots", "[world]") {
  WorldConfig c = config();
  c.snapshots.stack_bytes_max = 5'000;
  WorldBench bench(c);
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.tick();
  CHECK(bench.environment.loads.empty());
  for (std::int32_t x = 1; x < 20; ++x)
    bench.edit(1, static_cast<ClientSequence>(x + 1), SetVoxel{{x * kEdge, 1, 1}});
  bench.tick();
  CHECK_FALSE(bench.environment.loads.empty());
}

}  // namespace runstone
