#include "common/formats/turned_names.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/core/material_row.hpp"
#include "common/formats/facing_words.hpp"
#include "common/formats/minecraft_blocks.hpp"
#include "common/formats/minecraft_shapes.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/shape_names.hpp"
#include "common/shapes/shape_states.hpp"
#include "common/shapes/turned_shape.hpp"

namespace runstone {
namespace {

constexpr std::array<std::string_view, 3> kAxisWords = {"x", "y", "z"};

/// States that are changed: the keys point into names and rules, and values are kept.
using TurnedStates = std::vector<std::pair<std::string_view, std::string>>;

class NameTurn {
 public:
  NameTurn(std::array<Axis, 3> along, std::uint8_t flips) : along_(along), flips_(flips) {}

  /// Returns the place in the world of a direction of the build.
  Direction image(Direction d) const {
    const Axis axis = world_axis(axis_of(d));
    const bool is_flipped = (flips_ >> static_cast<unsigned>(axis) & 1) != 0;
    return static_cast<Direction>(static_cast<unsigned>(axis) * 2 +
                                  (is_positive(d) != is_flipped ? 1 : 0));
  }
  Axis world_axis(Axis axis) const {
    return static_cast<Axis>(std::find(along_.begin(), along_.end(), axis) - along_.begin());
  }
  /// Returns true if y lies along y.
  bool is_upright() const { return along_[1] == Axis::y; }
  bool is_upside_down() const { return is_upright() && (flips_ & 2) != 0; }
  /// Returns true if left and right are swapped as seen from above.
  bool is_mirrored() const {
    return is_upright() && ((along_[0] != Axis::x) != ((flips_ & 1) != 0)) != ((flips_ & 4) != 0);
  }
  Shape shape(const Shape& before) const { return turned(before, along_, flips_); }

  /// Changes the states. Returns false if there is no such state.
  bool turn(std::string_view block, TurnedStates& states) const {
    for (auto& [key, value] : states) {
      if (!turn_value(block, key, value)) return false;
    }
    return turn_sides(states, block.ends_with("_wall"));
  }

 private:
  bool turn_value(std::string_view block, std::string_view key, std::string& value) const {
    const auto swap_if = [&](bool is_swapped, std::string_view a, std::string_view b) {
      if (!is_swapped) return;
      if (value == a) {
        value = b;
      } else if (value == b) {
        value = a;
      }
    };
    if (key == "facing") {
      const auto d = direction_of_facing(value);
      if (d) value = facing_word(image(*d));
      return d.has_value();
    }
    if (key == "axis") {
      const auto axis = std::find(kAxisWords.begin(), kAxisWords.end(), value);
      if (axis == kAxisWords.end()) return false;
      value = kAxisWords[static_cast<std::size_t>(
          world_axis(static_cast<Axis>(axis - kAxisWords.begin())))];
      return true;
    }
    if (key == "rotation") return turn_rotation(value);
    if (key == "orientation") return turn_pair(value, false);
    if (key == "shape" &&
        (value.find("left") != std::string::npos || value.find("right") != std::string::npos)) {
      swap_if(is_mirrored(), "inner_left", "inner_right");
      swap_if(is_mirrored(), "outer_left", "outer_right");
      return true;
    }
    if (key == "shape" && value != "straight") return turn_rail(value);
    if (key == "hinge" || key == "side_chain") swap_if(is_mirrored(), "left", "right");
    if (key == "type") {
      swap_if(is_mirrored(), "left", "right");
      swap_if(is_upside_down(), "bottom", "top");
    }
    if (key == "half") {
      swap_if(is_upside_down(), "bottom", "top");
      swap_if(is_upside_down() && block.ends_with("_door"), "lower", "upper");
    }
    if (key == "face" || key == "attachment") swap_if(is_upside_down(), "floor", "ceiling");
    if (key == "vertical_direction") swap_if(is_upside_down(), "up", "down");
    return true;
  }

  /// A rotation counts sixteenths of a turn from south over west, north and east.
  bool turn_rotation(std::string& value) const {
    if (!is_upright()) return false;
    const unsigned before = ShapeStates("r=" + value).number("r", 16);
    if (before > 15) return false;
    constexpr std::array<Direction, 4> kQuarters = {Direction::pos_z, Direction::neg_x,
                                                    Direction::neg_z, Direction::pos_x};
    const auto* south = std::find(kQuarters.begin(), kQuarters.end(), image(Direction::pos_z));
    const auto base = static_cast<unsigned>(south - kQuarters.begin()) * 4;
    value = std::to_string((is_mirrored() ? base + 16 - before : base + before) % 16);
    return true;
  }

  /// Turns two directions with '_' between them. `is_plan`: they are horizontal, and named north or
  /// south first.
  bool turn_pair(std::string& value, bool is_plan) const {
    const std::size_t middle = value.find('_');
    if (middle == std::string::npos) return false;
    const auto first = direction_of_facing(std::string_view(value).substr(0, middle));
    const auto second = direction_of_facing(std::string_view(value).substr(middle + 1));
    if (!first || !second) return false;
    Direction a = image(*first), b = image(*second);
    if (is_plan && axis_of(a) != axis_of(b) && axis_of(a) != Axis::z) std::swap(a, b);
    if (is_plan && axis_of(a) == axis_of(b)) {
      a = axis_of(a) == Axis::z ? Direction::neg_z : Direction::pos_x;
      b = opposite(a);
    }
    value = std::string(facing_word(a)) + '_' + std::string(facing_word(b));
    return true;
  }

  bool turn_rail(std::string& value) const {
    if (!is_upright()) return false;
    constexpr std::string_view kRising = "ascending_";
    if (!value.starts_with(kRising)) return turn_pair(value, true);
    const auto d = direction_of_facing(std::string_view(value).substr(kRising.size()));
    if (d) value = std::string(kRising) + std::string(facing_word(image(*d)));
    return d.has_value();
  }

  /// Turns the states whose keys are directions: the sides that a block joins.
  bool turn_sides(TurnedStates& states, bool is_wall) const {
    const auto find = [](const TurnedStates& in, std::string_view key) {
      return std::find_if(in.begin(), in.end(), [&](const auto& s) { return s.first == key; });
    };
    const auto is_side = [&](std::string_view key) {
      // The state "up" of a wall is its post.
      return !(is_wall && key == "up") && direction_of_facing(key).has_value();
    };
    const TurnedStates before = states;
    for (auto& [key, value] : states) {
      // A side to which no other side is turned is free.
      if (is_side(key)) value = value == "true" || value == "false" ? "false" : "none";
    }
    for (const auto& [key, value] : before) {
      if (!is_side(key)) continue;
      const auto place = facing_word(image(*direction_of_facing(key)));
      const auto at = find(states, place);
      if (at != states.end() && is_side(place)) {
        states[static_cast<std::size_t>(at - states.begin())].second = value;
      } else if (value != "false" && value != "none") {
        return false;
      }
    }
    return true;
  }

  std::array<Axis, 3> along_;
  std::uint8_t flips_;
};

TurnedStates turnable(const StateList& states) {
  TurnedStates out;
  for (const auto& [key, value] : states) out.emplace_back(key, value);
  return out;
}

std::string joined(const TurnedStates& states) {
  StateList out;
  for (const auto& [key, value] : states) out.emplace_back(key, value);
  return join_states(out);
}

/// Returns the stairs that look like this shape. Stairs that lie on their side are others that
/// stand.
std::optional<ForeignBlock> stairs_like(const Shape& wanted, const ForeignBlock& stairs) {
  for (const std::string_view bend :
       {"straight", "inner_left", "inner_right", "outer_left", "outer_right"}) {
    for (const std::string_view half : {"bottom", "top"}) {
      for (const std::string_view facing : {"north", "east", "south", "west"}) {
        ForeignBlock out = stairs;
        TurnedStates states = turnable(split_states(stairs.states).value_or(StateList{}));
        for (auto& [key, value] : states) {
          if (key == "shape") value = bend;
          if (key == "half") value = half;
          if (key == "facing") value = facing;
        }
        out.states = joined(states);
        const auto shape = shape_of_minecraft_block(out);
        if (shape && look_alike(*shape, wanted)) return out;
      }
    }
  }
  return std::nullopt;
}

std::optional<ForeignBlock> turned_block(const ForeignBlock& block, const NameTurn& turn) {
  const auto split = split_states(block.states);
  if (!split) return std::nullopt;
  const std::string_view path = std::string_view(block.name).substr(block.name.find(':') + 1);
  const auto properties = minecraft_properties(path);
  const auto property_of = [&](std::string_view key) {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](MinecraftProperty p) { return key_of(p) == key; });
    return found == properties.end() ? MinecraftProperty() : *found;
  };
  const auto before = shape_of_minecraft_block(block);
  if (before && before->form == ShapeForm::crossed && (!turn.is_upright() || turn.is_upside_down()))
    return std::nullopt;
  TurnedStates states = turnable(*split);
  bool is_state = turn.turn(path, states);
  for (const auto& [key, value] : states) {
    const MinecraftProperty property = property_of(key);
    // The values of blocks that no rule knows are taken to be those that lie in the plane.
    if (property.empty() ? !turn.is_upright() : !index_of_value(property, value)) is_state = false;
  }
  ForeignBlock out{block.name, joined(states)};
  if (!before) return is_state ? std::optional(out) : std::nullopt;
  const Shape wanted = turn.shape(*before);
  if (is_state) {
    const auto after = shape_of_minecraft_block(out);
    if (after && look_alike(*after, wanted)) return out;
  }
  return path.ends_with("_stairs") ? stairs_like(wanted, block) : std::nullopt;
}

}  // namespace

std::optional<std::string> turned_material_name(std::string_view name, std::array<Axis, 3> along,
                                                std::uint8_t flips) {
  if (along == std::array{Axis::x, Axis::y, Axis::z} && flips == 0) return std::string(name);
  if (auto node = turned_node_name(name, along, flips)) {
    if (node->empty()) return std::nullopt;
    return node;
  }
  const NameTurn turn(along, flips);
  const auto block = is_luanti_node(name) ? std::nullopt : block_of_minecraft_material(name);
  if (block) {
    const auto out = turned_block(*block, turn);
    if (!out) return std::nullopt;
    std::string text = minecraft_material_name(*out);
    // A name that is too long for its states has none that leads back to a block.
    if (text.find('#') != std::string::npos) return std::nullopt;
    return text;
  }
  // The param2 of a node that only a rule of Minecraft knows does not say how it lies.
  const auto shape = shape_of_material_name(name);
  if (shape && !look_alike(*shape, turned(*shape, along, flips))) return std::nullopt;
  const std::string_view in_brackets = states_in_name(name);
  const auto split = split_states(in_brackets);
  if (in_brackets.empty() || !split) return std::string(name);
  TurnedStates states = turnable(*split);
  if (!turn.is_upright() || !turn.turn(name.substr(0, name.find('[')), states)) return std::nullopt;
  std::string out(name.substr(0, name.find('[') + 1));
  out += joined(states) + ']';
  if (out.size() > kMaterialNameBytesMax) return std::nullopt;
  return out;
}

std::string stuck_notice(std::size_t stuck) {
  if (stuck == 0) return {};
  if (stuck == 1) return "1 material has no state for the new direction, and lies as before";
  return std::to_string(stuck) +
         " materials have no state for the new direction, and lie as before";
}

}  // namespace runstone
