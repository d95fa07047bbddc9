// The shapes of all blocks of Minecraft that the tree has a row for, in all their states, and how
// these states turn.
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_shapes.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/shape_names.hpp"
#include "common/formats/turned_names.hpp"
#include "common/shapes/shape_faces.hpp"
#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone::test {
namespace {

/// Returns the names that the rules of states, colours and shapes have, without namespace. An
/// example stands for each beginning or end of a name.
const std::vector<std::string>& known_block_names() {
  static const std::vector<std::string> names = [] {
    std::set<std::string> out;
    const std::regex text(R"re("([a-z_0-9 *]+)")re"), word(R"([a-z_0-9*]+)");
    for (const char* file : {"minecraft_states.cpp", "minecraft_colours.cpp",
                             "minecraft_shapes.cpp", "minecraft_numbers.cpp"}) {
      std::ifstream in(std::string(RUNSTONE_SOURCE_DIR "/common/formats/") + file);
      const std::string source((std::istreambuf_iterator<char>(in)), {});
      for (std::sregex_iterator at(source.begin(), source.end(), text), end; at != end; ++at) {
        const std::string list = (*at)[1];
        for (std::sregex_iterator one(list.begin(), list.end(), word); one != end; ++one) {
          std::string name = one->str();
          if (name.front() == '*') name.replace(0, 1, name[1] == '_' ? "oak" : "oak_");
          if (name.back() == '*') name.replace(name.size() - 1, 1, "fern");
          if (name.front() == '_') name.insert(0, "oak");
          out.insert(name);
        }
      }
    }
    return std::vector<std::string>(out.begin(), out.end());
  }();
  return names;
}

/// Calls act(block) for a block in each of its states.
template <class Act>
void for_each_state(const std::string& name, Act act) {
  const auto properties = minecraft_properties(name);
  std::vector<std::size_t> at(properties.size());
  while (true) {
    StateList states;
    for (std::size_t i = 0; i < at.size(); ++i)
      states.emplace_back(key_of(properties[i]), value_of(properties[i], at[i]));
    act(ForeignBlock{"minecraft:" + name, join_states(states)});
    std::size_t i = 0;
    while (i < at.size() && ++at[i] == value_count(properties[i])) at[i++] = 0;
    if (i == at.size()) return;
  }
}

struct NamedTurn {
  const char* name;
  std::array<Axis, 3> along;
  std::uint8_t flips;
  int order;  // applying it so often is the identity
};
constexpr Axis kX = Axis::x, kY = Axis::y, kZ = Axis::z;
// As turned_about_y(shape, 1): north goes to east.
constexpr NamedTurn kQuarter{"quarter", {kZ, kY, kX}, 1, 4};
constexpr NamedTurn kTurns[] = {
    kQuarter,
    {"mirror x", {kX, kY, kZ}, 1, 2},
    {"mirror z", {kX, kY, kZ}, 4, 2},
    {"mirror y", {kX, kY, kZ}, 2, 2},
    {"swap x and z", {kZ, kY, kX}, 0, 2},
    {"tilt about x", {kX, kZ, kY}, 4, 4},
    {"tilt about z", {kY, kX, kZ}, 1, 4},
    {"roll", {kY, kZ, kX}, 0, 3},
};

std::optional<std::string> turned_name(const std::string& name, const NamedTurn& turn) {
  return turned_material_name(name, turn.along, turn.flips);
}

}  // namespace

TEST_CASE("every block in every state has a shape that a material may have, or none",
          "[formats][shapes]") {
  REQUIRE(known_block_names().size() > 400);
  std::size_t states = 0, shapes = 0, most = 0;
  std::set<Shape> seen;
  for (const std::string& name : known_block_names()) {
    for_each_state(name, [&](const ForeignBlock& block) {
      ++states;
      const auto shape = shape_of_minecraft_block(block);
      if (!shape) return;
      ++shapes;
      if (!seen.insert(*shape).second) return;
      CAPTURE(block.name, block.states);
      REQUIRE_FALSE(shape->is_cube());
      REQUIRE(check_shape(*shape));
      most = std::max(most, shape->boxes.size());
    });
  }
  CHECK(states > 10'000);
  CHECK(shapes > 5'000);
  CHECK(most < kShapeBoxesMax / 2);
}

TEST_CASE("turned names have the turned shape, and turns that undo each other give the name back",
          "[formats][shapes]") {
  for (const std::string& name : known_block_names()) {
    for_each_state(name, [&](const ForeignBlock& block) {
      const std::string before = minecraft_material_name(block);
      const auto shape = shape_of_material_name(before);
      for (const NamedTurn& turn : kTurns) {
        std::optional<std::string> after = turned_name(before, turn);
        if (!after) continue;
        if (shape) {
          const auto turned_after = shape_of_material_name(*after);
          if (!turned_after || !look_alike(*turned_after, turned(*shape, turn.along, turn.flips))) {
            FAIL_CHECK(turn.name << " of " << before << " looks wrong: " << *after);
            continue;
          }
        }
        for (int i = 1; after && i < turn.order; ++i) after = turned_name(*after, turn);
        // Half way round there may be no such state, unless y stays upright.
        if (!after && turn.along[1] != kY) continue;
        // Stairs on their side are others that stand, so that several names are one shape.
        const bool is_alike = after && shape && turn.along[1] != kY &&
                              look_alike(*shape_of_material_name(*after), *shape);
        if (after != before && !is_alike)
          FAIL_CHECK(turn.name << " of " << before << ", all round: " << after.value_or("none"));
      }
    });
  }
}

TEST_CASE("every block turns about y and is mirrored, unless no state says how it lies",
          "[formats][shapes]") {
  // A cake is eaten from the west.
  const std::set<std::string> exceptions = {"cake"};
  for (const std::string& name : known_block_names()) {
    if (exceptions.count(name) != 0) continue;
    for_each_state(name, [&](const ForeignBlock& block) {
      const std::string before = minecraft_material_name(block);
      for (const NamedTurn& turn : {kTurns[0], kTurns[1], kTurns[2]}) {
        if (!turned_name(before, turn))
          FAIL_CHECK(turn.name << " of " << before << " has no state");
      }
    });
  }
}

}  // namespace runstone::test
