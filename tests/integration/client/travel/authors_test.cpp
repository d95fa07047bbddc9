// Clients learn who edited when, and what a rollback would change, from a real server on loopback.
#include <catch2/catch.hpp>

#include "client/panels/rollback_control.hpp"
#include "common/mesh_materials/mesh_materials_of.hpp"
#include "tests/integration/client/travel/live_session.hpp"
#include "tests/integration/server/app/server_bench.hpp"
#include "tests/integration/server/app/server_commands.hpp"

namespace runstone::test {
namespace {

constexpr View kNearView{1, {0, 0, 0}, 2, 1};

EditDescriptor sphere(VoxelPos at, Material material) { return {FillSphere{at, 3}, {}, material}; }

}  // namespace

TEST_CASE("a timeline has the authors of the log, by name", "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  LiveSession one(server->port(), kNearView), two(server->port(), kNearView);
  one.catch_up();
  two.catch_up();
  for (int i = 0; i < 6; ++i) {
    one.edit(sphere({i * 4, 10, 0}, 3));
    one.catch_up();
  }
  two.edit({SetVoxel{{0, 20, 0}}, {}, 5});
  two.catch_up();
  const LogTimeline& log = one.session().timeline();
  one.until([&] {
    one.session().step_timeline(steady_now_us());
    return log.band().size() == 7 && log.recent().size() == 7;
  });
  CHECK(log.first() == 1);
  CHECK(log.refusal().empty());
  for (std::size_t i = 0; i < 7; ++i) {
    const LogMark& mark = log.band()[i];
    CHECK(mark.seq == i + 1);
    CHECK(mark.author == (i < 6 ? one.session().author() : two.session().author()));
    CHECK(mark.kind == (i < 6 ? EditKind::fill_sphere : EditKind::set_voxel));
    CHECK(mark.cause == Cause::player);
    CHECK(mark.utc_us > 0);
  }
  CHECK(log.recent() == log.band());
  CHECK(log.name_of(log.band()[0].author)[0] != '#');
  server->stop();
}

TEST_CASE("a client sees what a rollback would change, applies it, and takes it back", "[travel]") {
  const TempFolder folder;
  auto server = start_server(quiet_config(folder.path()), flat_creation());
  LiveSession griefer(server->port(), kNearView), host(server->port(), kNearView);
  griefer.catch_up();
  host.catch_up();
  RollbackControl rollback(host.session());
  rollback.set_materials(mesh_materials_of(host.session().welcome()->materials));
  const auto finish = [&] {
    host.until([&] {
      rollback.step();
      return !rollback.is_busy();
    });
  };
  const std::string filter = "author #" + std::to_string(griefer.session().author());
  CHECK(rollback.preview(filter).empty());
  finish();
  CHECK_FALSE(rollback.has_succeeded());  // a builder may not

  // A player who has built has a row, so the server knows the number.
  host.edit({SetVoxel{{-9, 40, -9}}, {}, 2});
  host.catch_up();
  REQUIRE(control(folder.path(),
                  {"grant", "#" + std::to_string(host.session().author()), "administrator"})
              .is_ok);
  const auto before = griefer.replica().shown_at({4, 24, 4});
  griefer.edit(sphere({4, 24, 4}, 6));
  griefer.catch_up();
  host.until([&] { return host.replica().shown_at({4, 24, 4}) == Material{6}; });
  CHECK(rollback.preview(filter).empty());
  finish();
  INFO(rollback.answer().at(0));
  REQUIRE(rollback.has_succeeded());
  RollbackState state;
  rollback.fill(state);
  CHECK(state.phase == RollbackPhase::previewed);
  CHECK(state.voxels > 100);
  CHECK(state.placed + state.removed == state.voxels);  // all of it is in view
  CHECK_FALSE(rollback.ghosts().empty());
  CHECK(rollback.carry_out(ApplyRollback{}, {}, {}).empty());
  finish();
  CHECK(rollback.has_succeeded());
  host.until([&] { return host.replica().shown_at({4, 24, 4}) == before; });
  CHECK(rollback.carry_out(UndoRollback{}, {}, {}).empty());
  finish();
  CHECK(rollback.has_succeeded());
  host.until([&] { return host.replica().shown_at({4, 24, 4}) == Material{6}; });
  server->stop();
}

}  // namespace runstone::test
