#include "common/materials/material_table.hpp"

#include <catch2/catch.hpp>
#include <limits>

using namespace runstone;

namespace {

MaterialInfo named(std::string name) {
  return {std::move(name), {1, 2, 3, 255}, Visibility::opaque, std::nullopt};
}

}  // namespace

TEST_CASE("a new table holds air and nothing else", "[materials]") {
  const MaterialTable table;
  REQUIRE(table.size() == 1);
  CHECK(table.knows(kEmpty));
  CHECK_FALSE(table.knows(1));
  CHECK(table[kEmpty].name == "air");
  CHECK(table[kEmpty].visibility == Visibility::empty);
  CHECK(table.find("air") == kEmpty);
  CHECK_FALSE(table.find("stone").has_value());
}

TEST_CASE("rows get ascending ids and are found by name", "[materials]") {
  MaterialTable table;
  REQUIRE(table.add(named("b")).value() == 1);
  REQUIRE(table.add(named("a")).value() == 2);
  CHECK(table.find("b") == Material{1});
  CHECK(table.find("a") == Material{2});
  CHECK(table[2].name == "a");
  CHECK(table.rows().size() == 3);
}

TEST_CASE("a name is 1 to 64 bytes of UTF-8 without control characters", "[materials]") {
  const auto accepted = [](std::string name) {
    return MaterialTable{}.add(named(std::move(name))).has_value();
  };
  CHECK_FALSE(accepted(""));
  CHECK(accepted(std::string(64, 'x')));
  CHECK_FALSE(accepted(std::string(65, 'x')));
  CHECK_FALSE(accepted("tab\there"));
  CHECK_FALSE(accepted("line\n"));
  CHECK_FALSE(accepted("\x7f"));
  CHECK_FALSE(accepted(std::string("nul\0", 4)));
  CHECK(accepted("gr\xc3\xbcn"));
  CHECK(accepted("\xe7\x9f\xb3"));
  CHECK(accepted("\xf0\x9f\xaa\xa8"));
  CHECK_FALSE(accepted("\xc3"));              // truncated
  CHECK_FALSE(accepted("\xbc"));              // continuation without a lead
  CHECK_FALSE(accepted("\xc0\xaf"));          // overlong
  CHECK_FALSE(accepted("\xe0\x9f\xbf"));      // overlong
  CHECK_FALSE(accepted("\xed\xa0\x80"));      // surrogate
  CHECK_FALSE(accepted("\xf4\x90\x80\x80"));  // beyond U+10FFFF
}

TEST_CASE("a duplicate name is rejected and changes nothing", "[materials]") {
  MaterialTable table;
  REQUIRE(table.add(named("stone")).has_value());
  const MaterialTable before = table;
  CHECK(table.add(named("stone")).error().code == ErrorCode::bad_value);
  CHECK(table.add(named("air")).error().code == ErrorCode::bad_value);
  CHECK(table == before);
}

TEST_CASE("an opaque material cannot have a transparent colour", "[materials]") {
  MaterialTable table;
  MaterialInfo info = named("film");
  info.colour[3] = 254;
  CHECK(table.add(info).error().code == ErrorCode::bad_value);
  info.visibility = Visibility::transparent;
  CHECK(table.add(info).has_value());
}

TEST_CASE("generation numbers stay in their ranges", "[materials]") {
  const auto accepted = [](SurfaceRule surface,
                           std::optional<SurfaceRule> reversed = std::nullopt) {
    MaterialInfo info = named("rock");
    info.generation = GenerationRule{surface, reversed};
    return MaterialTable{}.add(info).has_value();
  };
  CHECK(accepted({1, 10000, -10000, 1}));
  CHECK_FALSE(accepted({1, 10001, 0, 0.1}));
  CHECK_FALSE(accepted({1, 0, -10001, 0.1}));
  CHECK_FALSE(accepted({1, 0, 0, 0}));
  CHECK_FALSE(accepted({1, 0, 0, 1.01}));
  CHECK_FALSE(accepted({1, 0, 0, std::numeric_limits<double>::quiet_NaN()}));
  CHECK_FALSE(accepted({1, std::numeric_limits<double>::quiet_NaN(), 0, 0.1}));
  CHECK_FALSE(accepted({1, 0, std::numeric_limits<double>::infinity(), 0.1}));
  CHECK_FALSE(accepted({1, 10, 0, 0.1}, SurfaceRule{1, 10, 0, 2}));
}

TEST_CASE("a table holds 65536 materials and no more", "[materials]") {
  MaterialTable table;
  for (std::size_t i = 1; i < kMaterialCountMax; ++i) {
    REQUIRE(table.add(named("m" + std::to_string(i))).has_value());
  }
  CHECK(table.size() == kMaterialCountMax);
  CHECK(table.find("m65535") == Material{65535});
  CHECK(table.add(named("one too many")).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("the built-in table keeps its ids and the thesis' rules", "[materials]") {
  const MaterialTable& table = default_material_table();
  // Worlds store these ids: a row may be appended, never moved.
  const char* names[] = {"air",         "grass",     "sand",        "dirt",        "stone",
                         "water",       "snow",      "gravel",      "clay",        "glass",
                         "planks",      "log",       "leaves",      "brick",       "cobble",
                         "stone_brick", "sandstone", "slate",       "marble",      "thatch",
                         "copper",      "gold",      "lamp",        "wool_white",  "wool_grey",
                         "wool_black",  "wool_red",  "wool_orange", "wool_yellow", "wool_green",
                         "wool_cyan",   "wool_blue", "wool_violet", "wool_pink",   "wool_brown"};
  REQUIRE(table.size() == std::size(names));
  for (std::size_t id = 0; id < std::size(names); ++id)
    CHECK(table[static_cast<Material>(id)].name == names[id]);
  CHECK(table[1].generation == GenerationRule{{1, 50, 40, 0.007}, std::nullopt});
  CHECK(table[2].generation == GenerationRule{{2, 50, 0, 0.007}, SurfaceRule{4, -1500, 300, 0.06}});
  CHECK(table[3].generation == GenerationRule{{3, 50, 20, 0.007}, std::nullopt});
  CHECK(table[4].generation == GenerationRule{{4, 60, 0, 0.01}, std::nullopt});
  for (std::size_t id = 5; id < table.size(); ++id)
    CHECK_FALSE(table[static_cast<Material>(id)].generation);
  CHECK(table[*table.find("water")].visibility == Visibility::transparent);
  CHECK(table[*table.find("glass")].visibility == Visibility::transparent);
}

TEST_CASE("rows are appended together or not at all, and the error names the bad one",
          "[materials]") {
  MaterialTable table;
  REQUIRE(table.add(named("stone")).has_value());
  const MaterialRow wool{"wool", {1, 2, 3, 255}, Visibility::opaque};
  const MaterialRow ice{"ice", {1, 2, 3, 90}, Visibility::transparent};
  const auto refused = [&](Material first, const std::vector<MaterialRow>& rows) {
    const MaterialTable before = table;
    const auto appended = table.append(first, rows);
    REQUIRE_FALSE(appended.has_value());
    CHECK(table == before);
    return appended.error();
  };
  CHECK(refused(1, {wool}).code == ErrorCode::broken_invariant);
  CHECK(refused(3, {wool}).code == ErrorCode::broken_invariant);
  CHECK(refused(2, {wool, {"stone", {}, Visibility::empty}}).offset == 1);
  CHECK(refused(2, {wool, ice, wool}).offset == 2);
  CHECK(refused(2, {{"air", {}, Visibility::empty}}).code == ErrorCode::bad_value);
  REQUIRE(table.append(2, std::vector{wool, ice}).has_value());
  CHECK(table.size() == 4);
  CHECK(table.find("ice") == Material{3});
  CHECK(table[3].visibility == Visibility::transparent);
  CHECK(table.append(4, {}).has_value());
}

TEST_CASE("a full table takes no rows", "[materials]") {
  MaterialTable table;
  while (table.size() < kMaterialCountMax - 1)
    REQUIRE(table.add(named(std::to_string(table.size()))).has_value());
  const auto last = static_cast<Material>(table.size());
  const MaterialRow one{"one", {1, 2, 3, 255}, Visibility::opaque};
  const MaterialRow two{"two", {1, 2, 3, 255}, Visibility::opaque};
  const auto refused = table.append(last, std::vector{one, two});
  REQUIRE_FALSE(refused.has_value());
  CHECK(refused.error().code == ErrorCode::limit_exceeded);
  CHECK(refused.error().offset == 1);
  CHECK(table.append(last, std::vector{one}).has_value());
  CHECK(table.check_rows(std::vector{two}).error().code == ErrorCode::limit_exceeded);
}

TEST_CASE("rows get a shape once, all of a list or none", "[materials][shapes]") {
  const Shape slab{ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  const Shape carpet{ShapeForm::boxes, {{{0, 0, 0}, {16, 1, 16}}}};
  MaterialTable table;
  REQUIRE(table.add(named("a")));
  REQUIRE(table.add(named("b")));
  REQUIRE(table.add({"nothing", {0, 0, 0, 0}, Visibility::empty, std::nullopt}));
  const MaterialTable before = table;
  const auto refused = [&](std::vector<GivenShape> given, std::uint64_t offset) {
    const auto done = table.give_shapes(given);
    REQUIRE_FALSE(done);
    CHECK(done.error().offset == offset);
    CHECK(table == before);
  };
  refused({{1, slab}, {4, slab}}, 1);
  refused({{1, slab}, {3, slab}}, 1);
  refused({{0, slab}}, 0);
  refused({{1, slab}, {2, slab}, {1, slab}}, 2);
  refused({{1, slab}, {2, Shape{}}}, 1);
  refused({{2, Shape{ShapeForm::boxes, {{{0, 0, 0}, {16, 0, 16}}}}}}, 0);
  REQUIRE(table.give_shapes(std::vector<GivenShape>{{2, carpet}, {1, slab}}));
  CHECK(table[1].shape == slab);
  CHECK(table[2].shape == carpet);
  CHECK(row_of(table[1]).shape == slab);
  CHECK_FALSE(table.give_shapes(std::vector<GivenShape>{{1, slab}}));

  CHECK(shapes_of(table) == std::vector<Shape>{{}, slab, carpet, {}});
  using enum Visibility;
  CHECK(visibilities(table) == std::vector<Visibility>{empty, opaque, opaque, empty});
  CHECK(cube_visibilities(table) == std::vector<Visibility>{empty, empty, empty, empty});
  CHECK(half_filled_visibilities(table) == std::vector<Visibility>{empty, opaque, empty, empty});
}

TEST_CASE("a row that is added keeps its shape, and an empty one must have none",
          "[materials][shapes]") {
  MaterialRow row{"slab", {1, 2, 3, 255}, Visibility::opaque};
  row.shape = {ShapeForm::boxes, {{{0, 0, 0}, {16, 8, 16}}}};
  MaterialTable table;
  REQUIRE(table.append(1, std::vector{row}));
  CHECK(table[1].shape == row.shape);
  row.name = "other";
  row.visibility = Visibility::empty;
  CHECK(table.check_rows(std::vector{row}).error().code == ErrorCode::bad_value);
  MaterialInfo info = named("bad");
  info.shape.form = ShapeForm::crossed;
  CHECK_FALSE(table.add(info));
}
