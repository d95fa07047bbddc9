#include "client/play/player_actions.hpp"

#include <catch2/catch.hpp>

#include "common/materials/palette.hpp"
#include "tests/unit/client/session/session_bench.hpp"

namespace runstone::test::player_actions_test {

using session_bench::SessionBench;

TEST_CASE_METHOD(SessionBench, "the wheel chooses a slot, resizes the tool or changes the speed",
                 "[client]") {
  Player player;
  Hotbar bar(player);
  bar.fill(default_material_table());
  LatencyRecorder recorder;
  ToolBox box;
  EditTool tool(session, player, recorder, box);
  REQUIRE(box.choose("sphere"));
  const std::int32_t size = box.tool().parameters().front().value;

  WindowInput input;
  CHECK_FALSE(act_on_wheel(input, tool, player, bar));
  input.scroll = -1;
  CHECK_FALSE(act_on_wheel(input, tool, player, bar));
  CHECK(bar.slot() == 1);

  input.scroll = 1;
  input.resizes = true;
  CHECK_FALSE(act_on_wheel(input, tool, player, bar));
  CHECK(box.tool().parameters().front().value == size + 1);

  input.resizes = false;
  input.fast = true;
  CHECK(act_on_wheel(input, tool, player, bar) == "flying speed: 24 voxels a second");
  player.set_walking(true);
  CHECK_FALSE(act_on_wheel(input, tool, player, bar));
  CHECK(bar.slot() == 0);
}

}  // namespace runstone::test::player_actions_test
