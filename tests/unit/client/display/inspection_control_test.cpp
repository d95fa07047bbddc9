#include "client/display/inspection_control.hpp"

#include <catch2/catch.hpp>

#include "tests/support/codec/authority_model.hpp"
#include "tests/support/codec/chunks_message.hpp"

using namespace runstone;

namespace {

MeshResult result_of(std::int32_t x, std::size_t layer) {
  MeshResult result;
  result.key = {0, {x, 0, 0}};
  for (auto& axis : result.layers.layer) axis.set(layer);
  return result;
}

struct ControlBench {
  ControlBench() {
    replica.set_view({1, {0, 0, 0}, 5, 0});
    static_cast<void>(replica.open({16, 5, 77, 1, 0, 0, 0}));
    for (std::int32_t x = -5; x <= 5; ++x)
      replica.receive(test::chunks_of(world.snapshot({x, 0, 0})), {});
  }
  Inspection at(TimeUs now_us, bool exact = false) const {
    return control.inspection(replica, {1, 0, 0}, exact, now_us);
  }

  test::AuthorityModel world{16, 1};
  Replica replica;
  InspectionControl control;
};

}  // namespace

TEST_CASE_METHOD(ControlBench, "with no mode on nothing is gathered", "[client_app]") {
  control.meshed(result_of(0, 3), 100);
  CHECK_FALSE(control.is_fading(100));
  const Inspection shown = at(100);
  CHECK(shown.chunks.empty());
  CHECK(shown.flashes.empty());
}

TEST_CASE_METHOD(ControlBench, "orders are shown of all chunks, ends of runs of those near the eye",
                 "[client_app]") {
  control.set(InspectionMode::runs, true);
  Inspection shown = at(0);
  CHECK(shown.chunks.size() == 7);
  CHECK(shown.chunks.front().key.at.x == -2);
  CHECK(shown.chunks.front().shows_runs);
  control.set(InspectionMode::orders, true);
  shown = at(0);
  REQUIRE(shown.chunks.size() == 11);
  CHECK(shown.chunks.front().key.at.x == -5);
  CHECK_FALSE(shown.chunks.front().shows_runs);
  CHECK(shown.chunks[5].shows_runs);
  CHECK(shown.chunks[5].voxels == replica.shown({0, {0, 0, 0}}));
}

TEST_CASE_METHOD(ControlBench, "layers flash when they are meshed, and fade", "[client_app]") {
  control.set(InspectionMode::layers, true);
  control.meshed(result_of(2, 3), 1'000'000);
  control.meshed(result_of(-1, 5), 1'200'000);
  control.meshed(result_of(2, 7), 1'200'000);
  Inspection shown = at(1'200'000);
  REQUIRE(shown.flashes.size() == 2);
  CHECK(shown.flashes[0].key.at.x == -1);
  CHECK(shown.flashes[0].strength == Approx(1));
  CHECK(shown.flashes[1].layers.layer[0].count() == 2);
  CHECK(control.is_fading(1'200'000));
  shown = at(1'500'000);
  REQUIRE(shown.flashes.size() == 2);
  CHECK(shown.flashes[1].layers.layer[0].test(7));
  CHECK_FALSE(shown.flashes[1].layers.layer[0].test(3));  // faded
  CHECK(shown.flashes[1].strength == Approx(0.25));
  CHECK(at(1'700'000).flashes.empty());
  CHECK_FALSE(control.is_fading(1'800'000));
}

TEST_CASE_METHOD(ControlBench, "an exact picture shows the newest layers however late it is drawn",
                 "[client_app]") {
  control.set(InspectionMode::layers, true);
  control.meshed(result_of(0, 3), 0);
  control.meshed(result_of(1, 4), 2'000'000);
  const Inspection shown = at(60'000'000, true);
  REQUIRE(shown.flashes.size() == 1);
  CHECK(shown.flashes[0].key.at.x == 1);
  CHECK(shown.flashes[0].strength == 1.0F);
  control.set(InspectionMode::layers, false);
  CHECK(at(60'000'000, true).flashes.empty());
}
