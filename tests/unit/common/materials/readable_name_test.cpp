#include "common/materials/readable_name.hpp"

#include <catch2/catch.hpp>

using namespace runstone;

TEST_CASE("a name for people has no prefix, no underscores and a capital letter", "[materials]") {
  CHECK(readable_name("stone") == "Stone");
  CHECK(readable_name("stone_brick") == "Stone brick");
  CHECK(readable_name("default:acacia_wood") == "Acacia wood");
  CHECK(readable_name("default:dirt_with_grass") == "Dirt with grass");
  CHECK(readable_name("a:b:c_d") == "C d");
}

TEST_CASE("a colour stands before its noun", "[materials]") {
  CHECK(readable_name("wool_red") == "Red wool");
  CHECK(readable_name("wool:red") == "Red wool");
  CHECK(readable_name("wool:dark_green") == "Dark green wool");
  CHECK(readable_name("mod:wool_dark_green") == "Dark green wool");
  CHECK(readable_name("red") == "Red");
  CHECK(readable_name("flowers:tulip_black") == "Black tulip");
  CHECK(readable_name("red_sand") == "Red sand");
}

TEST_CASE("a name without words stays as it is", "[materials]") {
  CHECK(readable_name("").empty());
  CHECK(readable_name("_") == "_");
  CHECK(readable_name("default:") == "default:");
  CHECK(readable_name("\xc3\xa9rable") == "\xc3\xa9rable");
  CHECK(readable_name("a__b_") == "A b");
}
