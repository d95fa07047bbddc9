#include "server/world/checkpointer.hpp"

#include <catch2/catch.hpp>

#include "tests/unit/server/world/fake_environment.hpp"

namespace runstone {
namespace {

struct Bench {
  EditLimits limits() const {
    EditLimits l;
    l.chunk_edge = 16;
    l.material_count = 4;
    return l;
  }
  Bench(SnapshotPolicy policy, LogPosition log, Sequence checkpoint)
      : authority(limits(), log),
        keeper(policy, checkpoint),
        durable(log.last),
        next_client(log.last + 1) {}

  void edit(std::int32_t chunk_x, Material material = 1) {
    const EditDescriptor edit{SetVoxel{{chunk_x * 16, 0, 0}}, {}, material};
    REQUIRE_FALSE(
        authority.submit({{1, 1, next_client++}, Cause::player, 0, edit}, true).has_value());
    (void)authority.commit({0, 0});
  }
  void step(TimeUs now_us = 0) {
    keeper.step(authority, durable, {now_us, 0}, ports, [&](const ChunkKey& key) {
      if (authority.chunks().begin_load(key)) ports.load_chunk(key);
    });
  }
  void answer_loads() {
    while (!ports.loads.empty()) {
      const ChunkKey key = ports.loads.front();
      ports.loads.pop_front();
      REQUIRE_FALSE(authority.chunks().loaded(key, test::empty_chunk(16)).has_value());
    }
  }

  Authority authority;
  Checkpointer keeper;
  test::FakeEnvironment ports;
  Sequence durable;
  ClientSequence next_client;
};

ChunkKey key_at(std::int32_t x) { return {0, {x, 0, 0}}; }

TEST_CASE("a round starts after enough edits or enough time, and not without edits", "[world]") {
  Bench bench({3, 1000, 10}, {1, 0, 0}, 0);
  bench.step(0);
  bench.step(5000);
  CHECK(bench.keeper.rounds() == 0);
  bench.edit(0);
  bench.edit(1);
  bench.step(5000);
  CHECK(bench.keeper.rounds() == 1);  // time
  bench.durable = 2;
  bench.answer_loads();
  bench.step(5000);
  REQUIRE(bench.ports.saves.size() == 1);
  bench.keeper.saved(bench.authority.chunks());
  bench.edit(0);
  bench.edit(0);
  bench.step(5001);
  CHECK(bench.keeper.rounds() == 1);
  bench.edit(0);
  bench.step(5002);
  CHECK(bench.keeper.rounds() == 2);  // edits
}

TEST_CASE("snapshots wait until what they hold is durable, also while edits keep coming",
          "[world]") {
  Bench bench({1, 1'000'000, 10}, {1, 0, 0}, 0);
  bench.edit(0, 1);
  bench.step();
  CHECK(bench.ports.loads == std::deque<ChunkKey>{key_at(0)});  // its stack needs a base
  bench.edit(0, 2);
  bench.answer_loads();  // now the chunk stands at 2
  bench.durable = 1;
  bench.step();
  CHECK(bench.ports.saves.empty());
  bench.edit(0, 3);
  bench.durable = 2;
  bench.step();
  REQUIRE(bench.ports.saves.size() == 1);
  CHECK(bench.ports.saves[0].checkpoint == 1);  // the head when the round began
  REQUIRE(bench.ports.saves[0].chunks.size() == 1);
  CHECK(bench.ports.saves[0].chunks[0].second->version == Version{1, 2});
  CHECK(bench.keeper.checkpoint() == 0);  // not before the answer
  bench.keeper.saved(bench.authority.chunks());
  CHECK(bench.keeper.checkpoint() == 1);
  CHECK(bench.authority.chunks().dirty().contains(key_at(0)));  // the third edit is in no snapshot
}

TEST_CASE("a round goes in slices and only the last one moves the checkpoint", "[world]") {
  Bench bench({5, 1'000'000, 2}, {1, 0, 0}, 0);
  for (std::int32_t x = 0; x < 5; ++x) bench.edit(x);
  bench.durable = 5;
  std::vector<std::size_t> sizes;
  for (int i = 0; i < 10 && bench.keeper.checkpoint() == 0; ++i) {
    bench.step();
    CHECK(bench.ports.loads.size() <= 2);
    bench.answer_loads();
    bench.step();
    if (bench.ports.saves.size() == sizes.size()) continue;
    const auto& save = bench.ports.saves.back();
    sizes.push_back(save.chunks.size());
    CHECK(save.checkpoint == (sizes.size() < 3 ? 0U : 5U));
    bench.keeper.saved(bench.authority.chunks());
  }
  CHECK(sizes == std::vector<std::size_t>{2, 2, 1});
  CHECK(bench.keeper.checkpoint() == 5);
  CHECK(bench.keeper.is_clean(bench.authority));
}

TEST_CASE("the checkpoint stays below the first edit that only the log has", "[world]") {
  Bench bench({4, 1'000'000, 10}, {1, 0, 0}, 0);
  bench.edit(0);
  bench.edit(7);  // sequence 2: its chunk will fail to load
  bench.edit(0);
  bench.edit(1);
  bench.step();
  while (!bench.ports.loads.empty()) {
    const ChunkKey key = bench.ports.loads.front();
    bench.ports.loads.pop_front();
    if (key == key_at(7)) {
      bench.authority.chunks().quarantine(key);
    } else {
      (void)bench.authority.chunks().loaded(key, test::empty_chunk(16));
    }
  }
  bench.durable = 4;
  bench.step();
  REQUIRE(bench.ports.saves.size() == 1);
  CHECK(bench.ports.saves[0].chunks.size() == 2);
  CHECK(bench.ports.saves[0].checkpoint == 1);
  bench.keeper.saved(bench.authority.chunks());
  CHECK(bench.keeper.is_clean(bench.authority));
}

TEST_CASE("finishing writes all that is dirty, restacked chunks included", "[world]") {
  Bench bench({1000, 1'000'000'000, 10}, {2, 3, 0}, 0);
  for (Sequence seq = 1; seq <= 3; ++seq) {
    bench.authority.replay_onto_stack(
        {{1, seq}, {1, 1, seq}, 0, Cause::player, {SetVoxel{{16, 1, 1}}, {}, 2}});
  }
  bench.step();
  CHECK(bench.keeper.rounds() == 0);
  CHECK_FALSE(bench.keeper.is_clean(bench.authority));
  bench.keeper.finish();
  bench.step();
  bench.answer_loads();
  bench.step();
  REQUIRE(bench.ports.saves.size() == 1);
  CHECK(bench.ports.saves[0].checkpoint == 3);
  CHECK(bench.ports.saves[0].chunks[0].second->version == Version{1, 3});
  bench.keeper.saved(bench.authority.chunks());
  bench.step();
  CHECK(bench.keeper.is_clean(bench.authority));
  CHECK(bench.ports.saves.size() == 1);
}

}  // namespace
}  // namespace runstone
