#include "server/world/order/checkpointer.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone {
namespace {

struct CheckpointerBench {
  EditLimits limits() const {
    EditLimits l;
    l.chunk_edge = 16;
    l.material_count = 4;
    return l;
  }
  CheckpointerBench(SnapshotPolicy policy, LogPosition log, Sequence checkpoint)
      : authority(limits(), log),
        checkpointer(policy, checkpoint),
        durable(log.last),
        next_client(log.last + 1) {}

  void edit(std::int32_t chunk_x, Material material = 1) {
    const EditDescriptor edit{SetVoxel{{chunk_x * 16, 0, 0}}, {}, material};
    REQUIRE(authority.enqueue({{1, 1, next_client++}, Cause::player, 0, edit}).has_value());
    (void)authority.commit({0, 0});
  }
  void step(TimeUs now_us = 0) {
    for (const ChunkKey& key : checkpointer.step(authority, durable, {now_us, 0}, environment)) {
      if (authority.chunks().begin_load(key)) environment.load_chunk(key);
    }
  }
  void answer_loads() {
    while (!environment.loads.empty()) {
      const ChunkKey key = environment.loads.front();
      environment.loads.pop_front();
      REQUIRE(authority.chunks().loaded(key, test::empty_chunk(16)).has_value());
    }
  }

  Authority authority;
  Checkpointer checkpointer;
  test::FakeEnvironment environment;
  Sequence durable;
  ClientSequence next_client;
};

ChunkKey key_at(std::int32_t x) { return {0, {x, 0, 0}}; }

TEST_CASE("a round starts after enough edits or enough time, and only after edits", "[world]") {
  CheckpointerBench bench({3, 1000, 10}, {1, 0, 0}, 0);
  bench.step(0);
  bench.step(5000);
  CHECK(bench.checkpointer.rounds() == 0);
  bench.edit(0);
  bench.edit(1);
  bench.step(5000);
  CHECK(bench.checkpointer.rounds() == 1);  // time
  bench.durable = 2;
  bench.answer_loads();
  bench.step(5000);
  REQUIRE(bench.environment.saves.size() == 1);
  bench.checkpointer.saved(bench.authority.chunks());
  bench.edit(0);
  bench.edit(0);
  bench.step(5001);
  CHECK(bench.checkpointer.rounds() == 1);
  bench.edit(0);
  bench.step(5002);
  CHECK(bench.checkpointer.rounds() == 2);  // edits
}

TEST_CASE("snapshots wait until their edits are durable, also while edits keep coming", "[world]") {
  CheckpointerBench bench({1, 1'000'000, 10}, {1, 0, 0}, 0);
  bench.edit(0, 1);
  bench.step();
  CHECK(bench.environment.loads == std::deque<ChunkKey>{key_at(0)});  // its stack needs a base
  bench.edit(0, 2);
  bench.answer_loads();  // the chunk is at version 2 now
  bench.durable = 1;
  bench.step();
  CHECK(bench.environment.saves.empty());
  bench.edit(0, 3);
  bench.durable = 2;
  bench.step();
  REQUIRE(bench.environment.saves.size() == 1);
  CHECK(bench.environment.saves[0].checkpoint == 1);  // the head when the round began
  REQUIRE(bench.environment.saves[0].chunks.size() == 1);
  CHECK(bench.environment.saves[0].chunks[0].second->version == Version{1, 2});
  CHECK(bench.checkpointer.checkpoint() == 0);  // the save is not answered yet
  bench.checkpointer.saved(bench.authority.chunks());
  CHECK(bench.checkpointer.checkpoint() == 1);
  CHECK(bench.authority.chunks().dirty().contains(key_at(0)));  // the third edit is in no snapshot
}

TEST_CASE("a round writes slices, and only the last one moves the checkpoint", "[world]") {
  CheckpointerBench bench({5, 1'000'000, 2}, {1, 0, 0}, 0);
  for (std::int32_t x = 0; x < 5; ++x) bench.edit(x);
  bench.durable = 5;
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 10 && bench.checkpointer.checkpoint() == 0; ++i) {
    bench.step();
    CHECK(bench.environment.loads.size() <= 2);
    bench.answer_loads();
    bench.step();
    if (bench.environment.saves.size() == sizes.size()) continue;
    const auto& save = bench.environment.saves.back();
    sizes.push_back(save.chunks.size());
    CHECK(save.checkpoint == (sizes.size() < 3 ? 0U : 5U));
    bench.checkpointer.saved(bench.authority.chunks());
  }
  CHECK(sizes == std::vector<std::size_t>{2, 2, 1});
  CHECK(bench.checkpointer.checkpoint() == 5);
  CHECK(bench.checkpointer.is_clean(bench.authority));
}

TEST_CASE("the checkpoint stays below the first edit that only the log has", "[world]") {
  CheckpointerBench bench({4, 1'000'000, 10}, {1, 0, 0}, 0);
  bench.edit(0);
  bench.edit(7);  // sequence 2: its chunk will fail to load
  bench.edit(0);
  bench.edit(1);
  bench.step();
  while (!bench.environment.loads.empty()) {
    const ChunkKey key = bench.environment.loads.front();
    bench.environment.loads.pop_front();
    if (key == key_at(7)) {
      bench.authority.chunks().quarantine(key);
    } else {
      (void)bench.authority.chunks().loaded(key, test::empty_chunk(16));
    }
  }
  bench.durable = 4;
  bench.step();
  REQUIRE(bench.environment.saves.size() == 1);
  CHECK(bench.environment.saves[0].chunks.size() == 2);
  CHECK(bench.environment.saves[0].checkpoint == 1);
  bench.checkpointer.saved(bench.authority.chunks());
  CHECK(bench.checkpointer.is_clean(bench.authority));
}

TEST_CASE("finish() writes every dirty chunk, also those that a start replayed", "[world]") {
  CheckpointerBench bench({1000, 1'000'000'000, 10}, {2, 3, 0}, 0);
  for (Sequence seq = 1; seq <= 3; ++seq) {
    bench.authority.replay_onto_stack(
        {{1, seq}, {1, 1, seq}, 0, Cause::player, {SetVoxel{{16, 1, 1}}, {}, 2}});
  }
  bench.step();
  CHECK(bench.checkpointer.rounds() == 0);
  CHECK_FALSE(bench.checkpointer.is_clean(bench.authority));
  bench.checkpointer.finish();
  bench.step();
  bench.answer_loads();
  bench.step();
  REQUIRE(bench.environment.saves.size() == 1);
  CHECK(bench.environment.saves[0].checkpoint == 3);
  CHECK(bench.environment.saves[0].chunks[0].second->version == Version{1, 3});
  bench.checkpointer.saved(bench.authority.chunks());
  bench.step();
  CHECK(bench.checkpointer.is_clean(bench.authority));
  CHECK(bench.environment.saves.size() == 1);
}

TEST_CASE("an abandoned round keeps the slices that were written and the checkpoint", "[world]") {
  CheckpointerBench bench({5, 1'000'000, 2}, {1, 0, 0}, 0);
  for (std::int32_t x = 0; x < 5; ++x) bench.edit(x);
  bench.durable = 5;
  bench.step();
  bench.answer_loads();
  bench.step();
  REQUIRE(bench.environment.saves.size() == 1);  // the first slice is being written
  bench.checkpointer.abandon();
  CHECK(bench.checkpointer.is_abandoned());
  bench.checkpointer.saved(bench.authority.chunks());
  bench.checkpointer.finish();
  bench.step();
  CHECK(bench.environment.loads.empty());
  CHECK(bench.environment.saves.size() == 1);
  CHECK(bench.checkpointer.checkpoint() == 0);
  CHECK(bench.authority.chunks().dirty() == std::set<ChunkKey>{key_at(2), key_at(3), key_at(4)});
  CHECK_FALSE(bench.checkpointer.is_clean(bench.authority));
}

}  // namespace
}  // namespace runstone
