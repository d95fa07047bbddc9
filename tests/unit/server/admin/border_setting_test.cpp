#include "server/admin/border_setting.hpp"

#include <catch2/catch.hpp>
#include <string>

#include "server/admin/command_table.hpp"
#include "server/world/environment/world_border.hpp"
#include "tests/support/core/text_contains.hpp"
#include "tests/unit/server/admin/command_bench.hpp"

namespace runstone::test {

TEST_CASE("the setting of the border takes columns or corners, both inside", "[admin][border]") {
  const auto columns = parse_border("499 499, -500 -500");
  REQUIRE(columns.has_value());
  REQUIRE(columns->has_value());
  CHECK(**columns == WorldBorder(VoxelBox{{-500, -kWorldLimit, -500}, {500, kWorldLimit, 500}}));
  CHECK(border_text(**columns) == "x -500 to 499, z -500 to 499");
  CHECK(border_setting_text(*columns) == "-500 -500 499 499");
  const auto corners = parse_border("0,10,0,5,20,7");
  REQUIRE(corners.has_value());
  CHECK(**corners == WorldBorder(VoxelBox{{0, 10, 0}, {6, 21, 8}}));
  CHECK(border_text(**corners) == "x 0 to 5, y 10 to 20, z 0 to 7");
  CHECK(border_setting_text(*corners) == "0 10 0 5 20 7");
  for (const char* text : {"", "  "}) {
    const auto none = parse_border(text);
    REQUIRE(none.has_value());
    CHECK_FALSE(none->has_value());
  }
  CHECK(border_setting_text(std::nullopt).empty());
}

TEST_CASE("the border may be a circle of columns", "[admin][border]") {
  const auto circle = parse_border(" circle 10, -20 500");
  REQUIRE(circle.has_value());
  REQUIRE(circle->has_value());
  CHECK(**circle == WorldBorder(BorderCircle{10, -20, 500}));
  CHECK(border_text(**circle) == "500 voxels around x 10, z -20");
  CHECK(border_words(**circle) == "circle 10 -20 500");
  CHECK(border_setting_text(*circle) == "circle 10 -20 500");
  CHECK(border_words(VoxelBox{{-5, 0, -6}, {7, 1, 8}}) == "box -5 -6 7 8");
  for (const char* text : {"circle", "circle 1 2", "circle 1 2 3 4", "circle 1 2 x", "round 1 2 3"})
    CHECK(contains(parse_border(text).error(), "or a circle, as in"));
  CHECK(contains(parse_border("circle 0 0 0").error(), "nobody could edit"));
  CHECK(contains(parse_border("circle 0 0 -5").error(), "nobody could edit"));
  CHECK(contains(parse_border("circle 0 0 999999999").error(), "outside every world"));
}

TEST_CASE("a box lies within a circle if all of its columns do", "[border]") {
  const WorldBorder circle = BorderCircle{0, 0, 5};
  const auto at = [&](std::int32_t x, std::int32_t z, std::int32_t side) {
    return is_within(circle, {{x, -900, z}, {x + side, 900, z + side}});
  };
  CHECK(at(3, 4, 1));
  CHECK_FALSE(at(4, 4, 1));
  CHECK(at(-5, 0, 1));
  CHECK_FALSE(at(-6, 0, 1));
  CHECK(at(-3, -3, 7));
  CHECK_FALSE(at(-3, -3, 8));
  // The squares of the largest distances fit.
  const WorldBorder all = BorderCircle{-kWorldLimit, -kWorldLimit, kWorldLimit - 1};
  CHECK_FALSE(
      is_within(all, {{kWorldLimit - 1, 0, kWorldLimit - 1}, {kWorldLimit, 1, kWorldLimit}}));
}

TEST_CASE("edits of players beyond a circle are refused with words", "[admin][border]") {
  WorldConfig bounded = config();
  bounded.border = BorderCircle{0, 0, 5};
  CommandBench bench(bounded);
  bench.join(kBuilder);
  bench.set(kBuilder, {3, 1, 4}, 1);
  bench.set(kBuilder, {4, 1, 4}, 1);
  bench.write_log();
  CHECK(bench.bench.server.order().head() == 1);
  const auto rejected = bench.bench.environment.messages<Reject>(kBuilder, kEdge);
  REQUIRE(rejected.size() == 1);
  CHECK(rejected[0].detail ==
        "the edit reaches beyond the border of this world: 5 voxels around x 0, z 0");
}

TEST_CASE("a border that is no box is refused with words", "[admin][border]") {
  for (const char* text :
       {"1 2 3", "1 2 3 4 5", "1 2 3 4 5 6 7", "a b c d", "1 2 3 4x", "1.5 2 3 4"})
    CHECK(contains(parse_border(text).error(), "must be x and z of two opposite columns"));
  CHECK(
      contains(parse_border("0 0 536870912 0").error(), "536870912, which is outside every world"));
  CHECK(contains(parse_border("-536870913 0 1 0").error(), "outside every world"));
  CHECK_FALSE(parse_border("99999999999 0 1 0").has_value());
}

TEST_CASE("edits of players beyond the border are refused with words", "[admin][border]") {
  WorldConfig bounded = config();
  bounded.border = VoxelBox{{0, 0, 0}, {8, 8, 8}};
  CommandBench bench(bounded);
  const AuthorId author = bench.join(kBuilder);
  bench.set(kBuilder, {7, 7, 7}, 1);
  bench.set(kBuilder, {8, 1, 1}, 1);
  bench.fill(kBuilder, {{4, 4, 4}, {9, 5, 5}}, 2);  // partly inside
  bench.write_log();
  CHECK(bench.bench.server.order().head() == 1);
  CHECK(bench.at({7, 7, 7}) == 1);
  CHECK(bench.at({4, 4, 4}) == kEmpty);
  const auto rejected = bench.bench.environment.messages<Reject>(kBuilder, kEdge);
  REQUIRE(rejected.size() == 2);
  CHECK(rejected[0].reason == RejectReason::outside_world);
  CHECK(rejected[0].detail ==
        "the edit reaches beyond the border of this world: x 0 to 7, y 0 to 7, z 0 to 7");
  // The server takes an edit back also where the border has excluded it since.
  WorldConfig smaller = bounded;
  smaller.border = VoxelBox{{0, 0, 0}, {4, 4, 4}};
  bench.bench.server.reconfigure(smaller);
  bench.service.undo(author, bench.bench.now(), bench.reply());
  bench.run_all();
  CHECK(bench.at({7, 7, 7}) == kEmpty);

  CommandServices services = bench.services();
  bench.answers.clear();
  give_command({services, {}, bench.bench.now(), bench.reply()}, "status");
  CHECK(contains(bench.answer().text, "\nborder: x 0 to 3, y 0 to 3, z 0 to 3"));
}

}  // namespace runstone::test
