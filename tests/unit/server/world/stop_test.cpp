// The end of a stop, and edits while the disk has no space.
#include <catch2/catch.hpp>

#include "tests/unit/server/world/world_bench.hpp"

namespace runstone {
namespace {

using namespace test;

EditShape voxel_in_chunk(std::int32_t x) { return SetVoxel{{x * kEdge + 1, 1, 1}}; }

}  // namespace

TEST_CASE("a stop ends at its limit once the log is durable, and leaves chunks that are not loaded",
          "[world]") {
  WorldConfig c = config();
  c.stop_us_max = 2'000'000;
  c.loads_in_flight_max = 2;
  WorldBench bench(c);
  bench.join(1, 1);
  for (std::int32_t x = 0; x < 10; ++x)
    bench.edit(1, static_cast<ClientSequence>(x + 1), voxel_in_chunk(x));
  bench.server.begin_stop(bench.now());
  CHECK(bench.environment.loads.size() == 2);  // nobody answers them
  bench.tick(1'999'999);
  CHECK_FALSE(bench.server.order().is_stop_overdue());
  bench.tick(1);
  CHECK(bench.server.order().is_stop_overdue());
  CHECK_FALSE(bench.server.order().is_flushed());  // no limit for the log
  bench.server.durable(9, bench.now());
  CHECK_FALSE(bench.server.order().is_flushed());
  bench.server.durable(10, bench.now());
  CHECK(bench.server.order().is_flushed());
  CHECK(bench.server.order().dirty_chunks() == 10);
  CHECK(bench.server.order().checkpoint() == 0);
  bench.answer_loads();  // late answers start no further loads and no snapshots
  CHECK(bench.environment.loads.empty());
  CHECK(bench.environment.saves.empty());
  CHECK(bench.server.order().is_flushed());
}

TEST_CASE("a slice that is written when a stop reaches its limit counts, and no slice follows it",
          "[world]") {
  WorldConfig c = config();
  c.stop_us_max = 2'000'000;
  c.snapshots.slice_chunks = 3;
  WorldBench bench(c);
  bench.join(1, 1);
  for (std::int32_t x = 0; x < 5; ++x)
    bench.edit(1, static_cast<ClientSequence>(x + 1), voxel_in_chunk(x));
  bench.server.begin_stop(bench.now());
  bench.server.durable(5, bench.now());
  bench.answer_loads();
  REQUIRE(bench.environment.saves.size() == 1);
  bench.tick(2'000'000);
  CHECK(bench.server.order().is_flushed());
  bench.server.snapshots_saved(bench.now());
  CHECK(bench.environment.saves.size() == 1);
  CHECK(bench.server.order().dirty_chunks() == 2);
  CHECK(bench.server.order().checkpoint() == 0);
}

TEST_CASE(
    "every session is told when the disk is full, when it is not, and when it joins meanwhile",
    "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.join(2, 2);
  const auto told = [&](SessionId session) {
    const auto durable = bench.environment.messages<Durable>(session, kEdge);
    return durable.empty() ? -1 : static_cast<int>(durable.back().is_read_only);
  };
  bench.tick();
  CHECK(told(2) == -1);
  bench.server.set_disk_is_full(true, bench.now());
  bench.tick();
  CHECK(told(1) == 1);
  CHECK(told(2) == 1);
  bench.join(3, 3);
  bench.tick(1'100'000);
  CHECK(told(3) == 1);
  bench.server.set_disk_is_full(false, bench.now());
  bench.tick();
  for (const SessionId session : {1U, 2U, 3U}) CHECK(told(session) == 0);
  const std::size_t sent = bench.environment.messages<Durable>(1, kEdge).size();
  bench.tick(1'100'000);
  CHECK(bench.environment.messages<Durable>(1, kEdge).size() == sent);
}

TEST_CASE("while the disk is full edits are rejected with that reason, and accepted again later",
          "[world]") {
  WorldBench bench;
  bench.join(1, 1);
  bench.edit(1, 1, kAtOrigin);
  bench.server.set_disk_is_full(true, bench.now());
  bench.edit(1, 2, kAtOrigin);
  CHECK(bench.environment.messages<Reject>(1, kEdge) ==
        std::vector<Reject>{{2, RejectReason::busy, "the world's disk is full or read-only", 0}});
  const std::vector<EditOffer> offers = {{{1, 99, 1}, Cause::rollback, 0, {kAtOrigin, {}, 2}, 0}};
  bench.environment.log_room = false;
  const auto busy = bench.server.changes().order_edits(offers, 0, bench.now());
  CHECK(busy.state == ServerEditsResult::State::busy);
  CHECK(std::string(busy.reason) == "the world's disk is full or read-only");
  CHECK(bench.environment.records.size() == 1);  // the edit that was accepted before
  bench.environment.log_room = true;
  bench.server.set_disk_is_full(false, bench.now());
  bench.edit(1, 3, kAtOrigin);
  bench.server.commit(bench.now());
  CHECK(bench.environment.records.size() == 2);
}

}  // namespace runstone
