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
  CHECK(**columns == VoxelBox{{-500, -kWorldLimit, -500}, {500, kWorldLimit, 500}});
  CHECK(border_text(**columns) == "x -500 to 499, z -500 to 499");
  CHECK(border_setting_text(*columns) == "-500 -500 499 499");
  const auto corners = parse_border("0,10,0,5,20,7");
  REQUIRE(corners.has_value());
  CHECK(*corners == VoxelBox{{0, 10, 0}, {6, 21, 8}});
  CHECK(border_text(**corners) == "x 0 to 5, y 10 to 20, z 0 to 7");
  CHECK(border_setting_text(*corners) == "0 10 0 5 20 7");
  for (const char* text : {"", "  "}) {
    const auto none = parse_border(text);
    REQUIRE(none.has_value());
    CHECK_FALSE(none->has_value());
  }
  CHECK(border_setting_text(std::nullopt).empty());
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
