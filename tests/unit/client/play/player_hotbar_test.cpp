#include "client/play/player_hotbar.hpp"

#include <catch2/catch.hpp>

#include "common/materials/palette.hpp"

namespace runstone::test::player_hotbar_test {

TEST_CASE("a player holds the material of the chosen slot", "[client]") {
  Player player;
  PlayerHotbar bar(player);
  bar.fill(default_material_table());
  CHECK(player.held() == bar.slots().slots()[0]);
  CHECK(bar.act(Action::hold_slot_3));
  CHECK(player.held() == bar.slots().slots()[2]);
  CHECK_FALSE(bar.act(Action::undo));
  bar.scroll(1);
  CHECK(player.held() == bar.slots().slots()[1]);
  bar.choose(kSlotCount);  // there is no such slot
  CHECK(bar.slots().slot() == 1);
  const Material stone = bar.slots().slots()[0];
  bar.hold(stone);
  CHECK(bar.slots().slot() == 0);
  CHECK(player.held() == stone);
}

TEST_CASE("a player never holds an empty slot", "[client]") {
  Player player;
  PlayerHotbar bar(player);
  MaterialTable table;  // a world with one block fills one slot
  const auto block =
      table.add({"block", {90, 90, 90, 255}, Visibility::opaque, {}, MaterialBody::solid});
  REQUIRE(block.has_value());
  bar.fill(table);
  REQUIRE(player.held() == *block);
  bar.choose(5);
  CHECK(player.held() == *block);
  bar.hold(kEmpty);
  CHECK(player.held() == *block);
  CHECK(bar.slots().slots()[5] == kEmpty);
}

}  // namespace runstone::test::player_hotbar_test
