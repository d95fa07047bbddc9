#include "client/far/horizon_recorder.hpp"

#include <catch2/catch.hpp>

#include "protocol/codec/view_tiles.hpp"
#include "tests/unit/client/far/some_tile.hpp"

using namespace runstone;
using namespace runstone::test;

TEST_CASE("the horizon is coarse when all roots are there, and complete when all is meshed",
          "[far]") {
  FarTiles tiles;
  View view;
  view.radius_h = 2;
  view.radius_v = 1;
  view.levels = 1;
  tiles.set_view(view, kTileEdge);
  HorizonRecorder recorder;
  CHECK_FALSE(recorder.is_open());
  recorder.begin(1'000);
  recorder.begin(2'000);
  recorder.look(tiles, true, 1'000);
  CHECK_FALSE(recorder.report().coarse_us.has_value());
  for (std::int32_t x = -2; x <= 2; ++x) {
    for (std::int32_t y = -2; y <= 2; ++y) {
      for (std::int32_t z = -2; z <= 2; ++z) tiles.receive_uniform({1, {x, y, z}}, 1);
    }
  }
  recorder.look(tiles, false, 50'000);
  CHECK(recorder.report().coarse_us == 49'000);
  CHECK(recorder.is_open());
  recorder.look(tiles, true, 90'000);
  CHECK(recorder.report().all_us == 89'000);
  CHECK_FALSE(recorder.is_open());
}
