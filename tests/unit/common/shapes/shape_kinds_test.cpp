#include "common/shapes/shape_kinds.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "common/shapes/shape_faces.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone::test {
namespace {

Shape kind(std::string_view name, std::string_view states = {}) {
  const auto out = shape_of_kind(name, states);
  REQUIRE(out);
  return *out;
}

Shape of_boxes(std::vector<ShapeBox> boxes) { return {ShapeForm::boxes, std::move(boxes)}; }

constexpr ShapeBox kLower{{0, 0, 0}, {16, 8, 16}}, kUpper{{0, 8, 0}, {16, 16, 16}};

}  // namespace

TEST_CASE("the high half of stairs lies where they face", "[shapes]") {
  CHECK(kind("stairs", "facing=north") == of_boxes({kLower, {{0, 8, 0}, {16, 16, 8}}}));
  CHECK(kind("stairs", "facing=east") == of_boxes({kLower, {{8, 8, 0}, {16, 16, 16}}}));
  CHECK(kind("stairs", "facing=south") == of_boxes({kLower, {{0, 8, 8}, {16, 16, 16}}}));
  CHECK(kind("stairs", "facing=west") == of_boxes({kLower, {{0, 8, 0}, {8, 16, 16}}}));
  CHECK(kind("stairs", "facing=east,half=top") == of_boxes({kUpper, {{8, 0, 0}, {16, 8, 16}}}));
  CHECK(kind("stairs", "facing=north,shape=outer_left") ==
        of_boxes({kLower, {{0, 8, 0}, {8, 16, 8}}}));
  CHECK(kind("stairs", "facing=north,shape=outer_right") ==
        of_boxes({kLower, {{8, 8, 0}, {16, 16, 8}}}));
  CHECK(kind("stairs", "facing=north,shape=inner_left") ==
        of_boxes({kLower, {{0, 8, 0}, {16, 16, 8}}, {{0, 8, 8}, {8, 16, 16}}}));
  CHECK(kind("stairs", "facing=east,shape=outer_left") ==
        of_boxes({kLower, {{8, 8, 0}, {16, 16, 8}}}));
}

TEST_CASE("slabs, panes and doors follow their states", "[shapes]") {
  CHECK(kind("slab") == of_boxes({kLower}));
  CHECK(kind("slab", "type=top") == of_boxes({kUpper}));
  CHECK(kind("slab", "half=top") == of_boxes({kUpper}));
  CHECK(kind("slab", "type=double").is_cube());
  CHECK(kind("snow", "layers=8").is_cube());
  CHECK(kind("snow", "layers=3") == of_boxes({{{0, 0, 0}, {16, 6, 16}}}));
  CHECK(kind("pane") == of_boxes({{{7, 0, 7}, {9, 16, 9}}}));
  CHECK(kind("pane", "east=true,north=false,west=true") ==
        of_boxes({{{7, 0, 7}, {9, 16, 9}}, {{9, 0, 7}, {16, 16, 9}}, {{0, 0, 7}, {7, 16, 9}}}));
  CHECK(kind("door", "facing=east") == of_boxes({{{0, 0, 0}, {3, 16, 16}}}));
  CHECK(kind("door", "facing=east,hinge=left,open=true") == of_boxes({{{0, 0, 0}, {16, 16, 3}}}));
  CHECK(kind("door", "facing=east,hinge=right,open=true") ==
        of_boxes({{{0, 0, 13}, {16, 16, 16}}}));
  CHECK(kind("trapdoor", "half=top") == of_boxes({{{0, 13, 0}, {16, 16, 16}}}));
  CHECK(kind("plant").form == ShapeForm::crossed);
}

TEST_CASE("kinds ascend, and each is a shape that a material may have", "[shapes]") {
  const auto names = shape_kinds();
  CHECK(std::is_sorted(names.begin(), names.end()));
  for (const std::string_view name : names) {
    CAPTURE(std::string(name));
    CHECK(check_shape(kind(name)));
  }
  CHECK_FALSE(shape_of_kind("slabs", ""));
  CHECK_FALSE(shape_of_kind("", ""));
}

TEST_CASE("states that are not well formed count as missing", "[shapes]") {
  for (const char* states :
       {"facing", "=", ",,,", "facing=", "facing=up,", "layers=99999", "x=1"}) {
    CAPTURE(states);
    CHECK(kind("stairs", states) == kind("stairs"));
    CHECK(kind("snow", states) == kind("snow"));
  }
}

TEST_CASE("kinds with a facing turn with it", "[shapes]") {
  for (const char* name :
       {"stairs", "fence_gate", "door", "trapdoor", "wall_torch", "ladder", "bed", "chest", "anvil",
        "wall_head", "wall_sign", "wall_banner", "button", "lever", "wall_hanging_sign"}) {
    for (const char* more : {"", ",open=true", ",half=top", ",shape=inner_right", ",type=left"}) {
      CAPTURE(name, more);
      if (std::string_view(name) == "trapdoor" && std::string_view(more) != ",open=true") continue;
      const Shape north = kind(name, std::string("facing=north") + more);
      unsigned quarters = 0;
      for (const char* facing : {"north", "east", "south", "west"}) {
        CHECK(kind(name, "facing=" + std::string(facing) + more) ==
              turned_about_y(north, quarters++));
      }
    }
  }
}

}  // namespace runstone::test
