#include "client/schedule/mesh_planner.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <memory>
#include <set>
#include <thread>

#include "client/schedule/mesh_pool.hpp"
#include "tests/support/authority_model.hpp"

using namespace runstone;
using runstone::test::AuthorityModel;

namespace {

constexpr std::int32_t kEdge = 16;

struct Fixture {
  Fixture() {
    replica.set_view({{0, 0, 0}, 1, 0});  // a cross of five chunks
    static_cast<void>(replica.open({kEdge, 5, 77, 1, 0, 0, 0}));
  }
  void load(ChunkCoord at) {
    replica.receive(world.snapshot(at), {});
    tell();
  }
  void load_all() {
    for (const ChunkCoord at : {ChunkCoord{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}}) load(at);
  }
  void commit(VoxelPos at, Material material) {
    REQUIRE(replica.receive(world.commit({9, 1, ++edits}, {SetVoxel{at}, {}, material}), {}).has_value());
    tell();
  }
  void tell() { planner.take(replica.take_news().chunks); }
  std::vector<ChunkCoord> drain() {
    std::vector<ChunkCoord> out;
    while (auto job = planner.next()) {
      out.push_back(job->key.at);
      last = std::move(*job);
    }
    return out;
  }
  AuthorityModel world{kEdge, 1};
  Replica replica;
  MeshPlanner planner{replica};
  MeshJob last;
  ClientSequence edits = 0;
};

}  // namespace

TEST_CASE_METHOD(Fixture, "a chunk waits for its neighbours in view and not for those beyond", "[schedule]") {
  load({0, 0, 0});
  CHECK(drain().empty());
  load({1, 0, 0});
  // Its one neighbour in view is here; the five beyond the view do not count.
  CHECK(drain() == std::vector<ChunkCoord>{{1, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::neg_x)] != nullptr);
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] == nullptr);
  load({-1, 0, 0});
  load({0, 0, 1});
  CHECK(drain() == std::vector<ChunkCoord>{{-1, 0, 0}, {0, 0, 1}});
  load({0, 0, -1});
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {0, 0, -1}});
  CHECK(planner.dirty_count() == 0);
}

TEST_CASE_METHOD(Fixture, "nobody waits for a neighbour that the server cannot send", "[schedule]") {
  load({0, 0, 0});
  load({-1, 0, 0});
  load({0, 0, 1});
  load({0, 0, -1});
  CHECK(drain().size() == 3);
  replica.receive(ChunkUnavailable{{{0, {1, 0, 0}}}, UnavailableReason::damaged});
  tell();
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(last.neighbours[static_cast<std::size_t>(Direction::pos_x)] == nullptr);
  CHECK(planner.dirty_count() == 0);
  load({1, 0, 0});  // after all: the side that stood open closes
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
}

TEST_CASE_METHOD(Fixture, "loading a view meshes every chunk once", "[schedule]") {
  load_all();
  CHECK(drain().size() == 5);
  CHECK(planner.jobs() == 5);
  CHECK(planner.chunks_meshed() == 5);
}

TEST_CASE_METHOD(Fixture, "an edit meshes its chunk again, and the neighbour only at the border",
                 "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  commit({15, 5, 5}, 2);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}, {1, 0, 0}});
}

TEST_CASE_METHOD(Fixture, "changes are joined and the job holds the newest runs", "[schedule]") {
  load_all();
  drain();
  commit({5, 5, 5}, 2);
  commit({6, 5, 5}, 3);
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
  CHECK(material_at(*last.chunk, {6, 5, 5}) == Material{3});
  CHECK(last.serial == replica.shown_serial({0, {0, 0, 0}}));
}

TEST_CASE_METHOD(Fixture, "edited chunks come first, then the nearest", "[schedule]") {
  planner.set_eye({1, 0, 0});
  load_all();
  auto order = drain();
  REQUIRE(order.size() == 5);
  CHECK(order[0] == ChunkCoord{1, 0, 0});
  CHECK(order[1] == ChunkCoord{0, 0, 0});
  CHECK(order[4] == ChunkCoord{-1, 0, 0});

  replica.receive(world.snapshot({0, 0, 0}), {});
  commit({5, 5, 5}, 2);    // here
  commit({-10, 5, 5}, 2);  // and far from the eye
  planner.set_eye({-1, 0, 0});
  order = drain();
  CHECK(order == std::vector<ChunkCoord>{{-1, 0, 0}, {0, 0, 0}});
}

TEST_CASE_METHOD(Fixture, "a result older than the one drawn, or of a chunk out of view, is not drawn",
                 "[schedule]") {
  load_all();
  std::map<ChunkCoord, std::uint64_t> first;
  while (auto job = planner.next()) first[job->key.at] = job->number;
  commit({5, 5, 5}, 2);
  const auto second = planner.next();
  REQUIRE(second);
  const ChunkKey here{0, {0, 0, 0}};
  CHECK(planner.accept(here, second->number));
  CHECK_FALSE(planner.accept(here, first[here.at]));
  CHECK_FALSE(planner.accept(here, second->number));
  replica.set_view({{5, 0, 0}, 1, 0});
  tell();
  CHECK_FALSE(planner.accept({0, {1, 0, 0}}, first[{1, 0, 0}]));
}

TEST_CASE_METHOD(Fixture,
                 "when the view moves, chunks at its old edge are meshed again with their new neighbours",
                 "[schedule]") {
  load_all();
  drain();
  replica.set_view({{1, 0, 0}, 1, 0});
  tell();
  planner.view_changed();
  CHECK(planner.dirty_count() == 0);
  load({1, 0, 1});
  load({1, 0, -1});
  CHECK(planner.dirty_count() == 3);  // both and (1, 0, 0), which had drawn its edges open
  load({2, 0, 0});
  const auto order = drain();
  CHECK(std::set<ChunkCoord>(order.begin(), order.end()) ==
        std::set<ChunkCoord>{{1, 0, 0}, {1, 0, 1}, {1, 0, -1}, {2, 0, 0}});
}

TEST_CASE_METHOD(Fixture, "a chunk that waited for a neighbour which left the view goes ahead",
                 "[schedule]") {
  load({0, 0, 0});
  load({1, 0, 0});
  drain();
  CHECK(planner.dirty_count() == 1);
  replica.set_view({{0, 0, 0}, 0, 0});
  tell();
  planner.view_changed();
  CHECK(drain() == std::vector<ChunkCoord>{{0, 0, 0}});
}

TEST_CASE_METHOD(Fixture, "workers mesh every job and say when", "[schedule]") {
  const unsigned workers = GENERATE(0U, 2U);
  CAPTURE(workers);
  load_all();
  commit({5, 5, 5}, 2);

  std::atomic<int> woken{0};
  std::atomic<std::int64_t> now{0};
  MaterialTable materials;
  for (int i = 0; i < 4; ++i) {
    MaterialInfo info;
    info.name = "m" + std::to_string(i);
    REQUIRE(materials.add(info).has_value());
  }
  auto pool = std::make_unique<MeshPool>(
      VisibilityTable(materials), workers, [&] { return now += 1000; }, [&] { ++woken; });
  std::vector<MeshResult> results;
  std::size_t pushed = 0;
  for (bool more = true; more || results.size() < pushed;) {
    more = false;
    while (pool->in_flight() < pool->capacity()) {
      auto job = planner.next();
      if (!job) break;
      REQUIRE(pool->push(std::move(*job)));
      ++pushed;
      more = true;
    }
    for (MeshResult& result : pool->take_results()) results.push_back(std::move(result));
    std::this_thread::yield();
  }
  REQUIRE(results.size() == 5);
  for (const MeshResult& result : results) {
    CHECK(result.edge == kEdge);
    CHECK(result.mesh_ns >= 1000);
    CHECK(result.meshed_us > 0);
    CHECK(result.serial == replica.shown_serial(result.key));
    CHECK(result.mesh.quad_count() == (result.key.at == ChunkCoord{0, 0, 0} ? 6 : 0));
  }
  CHECK(pool->in_flight() == 0);
  pool.reset();  // the last worker may still be on its way to wake us
  CHECK(woken == (workers == 0 ? 0 : 5));
}
