#include "client/play/world_kit.hpp"

#include <catch2/catch.hpp>

#include "client/play/hotbar.hpp"

namespace runstone::test {

TEST_CASE("a kit is read back from its line, and nothing else is a kit", "[client_app]") {
  const WorldKit kit{{1, 2, 3, 4, 5, 6, 7, 8, 65535}, 8, "sphere"};
  const std::string line = to_text(kit);
  CHECK(line == "sphere 8 1 2 3 4 5 6 7 8 65535");
  CHECK(line.size() <= kKitBytesMax);
  CHECK(parse_kit(line) == kit);
  for (std::size_t size = 0; size < line.size() - 4; ++size)
    CHECK_FALSE(parse_kit(line.substr(0, size)).has_value());
  CHECK_FALSE(parse_kit(line + " 9").has_value());
  CHECK_FALSE(parse_kit("sphere 9 1 2 3 4 5 6 7 8 9").has_value());
  CHECK_FALSE(parse_kit("sphere 0 1 2 3 4 5 6 7 8 65536").has_value());
  CHECK_FALSE(parse_kit(" 0 1 2 3 4 5 6 7 8 9").has_value());
  CHECK_FALSE(parse_kit(std::string(kKitBytesMax, 'x') + " 0 1 2 3 4 5 6 7 8 9").has_value());
}

TEST_CASE("a hotbar takes the materials that the world has", "[client_app]") {
  Player player;
  Hotbar hotbar(player);
  const MaterialTable materials = default_material_table();
  hotbar.fill(materials);
  const auto before = hotbar.slots();
  hotbar.take({3, kEmpty, 65535, 2, 2, 2, 2, 2, 2}, 3, materials);
  CHECK(hotbar.slots()[0] == 3);
  CHECK(hotbar.slots()[1] == before[1]);
  CHECK(hotbar.slots()[2] == before[2]);
  CHECK(hotbar.slot() == 3);
  CHECK(player.held() == 2);
}

}  // namespace runstone::test
