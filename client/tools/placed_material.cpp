#include "client/tools/placed_material.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/core/assert.hpp"
#include "common/edits/clipboard/orientation.hpp"
#include "common/formats/facing_words.hpp"
#include "common/formats/material_family.hpp"
#include "common/formats/minecraft_states.hpp"
#include "common/formats/shape_names.hpp"

namespace runstone {
namespace {

Direction nearest_look(const LookDirection& look) {
  const double level = std::max(std::abs(look.x), std::abs(look.z));
  if (std::abs(look.y) <= level) return horizontal_look(look);
  return look.y < 0 ? Direction::neg_y : Direction::pos_y;
}

/// Returns the rotation of what stands and faces the player: sixteenths of a turn from south over
/// west.
std::string facing_rotation(const LookDirection& look) {
  const double turns = std::atan2(look.x, -look.z) / (2 * std::numbers::pi);
  return std::to_string((std::lround(turns * 16) + 32) % 16);
}

/// Blocks whose front a player chooses otherwise than that it faces the player.
constexpr std::string_view kFacingAway =
    "*_stairs *_door *_bed *_fence_gate observer bell campfire soul_campfire";
constexpr std::string_view kOnFace =
    "*shulker_box end_rod *lightning_rod *_amethyst_bud amethyst_cluster";
constexpr std::string_view kOnWall =
    "ladder *wall_torch *wall_sign *wall_banner *wall_skull *wall_head *coral_wall_fan "
    "tripwire_hook";
constexpr std::string_view kStandsOrHangs =
    "*torch *_sign sign *_banner *_skull *_head *_coral_fan";

/// Returns the family of a block that stands in place of one that hangs on a wall, and the other
/// way round: "oak_sign" and "oak_wall_sign".
std::string standing_or_hanging(const std::string& family, bool hangs) {
  const std::size_t path = family.find(':') == std::string::npos ? 0 : family.find(':') + 1;
  constexpr std::string_view kWall = "wall_";
  const std::size_t wall = family.rfind(kWall);
  const bool has_wall =
      wall != std::string::npos && (wall == path || (wall > path && family[wall - 1] == '_'));
  if (has_wall == hangs) return family;
  std::string out = family;
  if (has_wall) return out.erase(wall, kWall.size());
  std::size_t word = family.rfind('_');
  if (family.ends_with("_coral_fan")) word = family.size() - std::string_view("_fan").size();
  return out.insert(word == std::string::npos || word < path ? path : word + 1, kWall);
}

class ClickStates {
 public:
  explicit ClickStates(const PlacedClick& click) : click_(click) {}

  bool is_on_side() const { return axis_of(click_.face) != Axis::y; }
  bool is_upper() const {
    return is_on_side() ? click_.height > 0.5 : click_.face == Direction::neg_y;
  }
  Direction ahead() const { return horizontal_look(click_.look); }

  /// Changes the states that a click chooses.
  void choose(MaterialStates& states) const {
    const std::string_view path = states.path();
    if (states.has("facing")) choose_facing(path, states);
    if (states.has("half") && !path.ends_with("_door") &&
        is_any(states.get("half"), "bottom", "top"))
      states.states["half"] = is_upper() ? "top" : "bottom";
    if (states.has("type") && is_any(states.get("type"), "bottom", "top"))
      states.states["type"] = is_upper() ? "top" : "bottom";
    if (path.ends_with("_stairs") && states.has("shape")) states.states["shape"] = "straight";
    if (states.has("axis")) {
      constexpr std::array<std::string_view, 3> kAxes = {"x", "y", "z"};
      states.states["axis"] = kAxes[static_cast<std::size_t>(axis_of(click_.face))];
    }
    if (states.has("face"))
      states.states["face"] = is_on_side() ? "wall" : is_upper() ? "ceiling" : "floor";
    if (states.has("rotation")) states.states["rotation"] = facing_rotation(click_.look);
    if (states.has("hanging") && path.ends_with("lantern"))
      states.states["hanging"] = click_.face == Direction::neg_y ? "true" : "false";
    if (states.has("vertical_direction") && !is_on_side())
      states.states["vertical_direction"] = is_upper() ? "down" : "up";
    if (states.has("shape") && path.ends_with("rail"))
      states.states["shape"] = axis_of(ahead()) == Axis::x ? "east_west" : "north_south";
    if (rule_names("vine glow_lichen resin_clump sculk_vein", path)) {
      for (const std::string_view side : kFacingWords) {
        const auto state = states.states.find(side);
        if (state != states.states.end())
          state->second = side == facing_word(opposite(click_.face)) ? "true" : "false";
      }
    }
  }

  /// Returns the name of a node of Luanti as a click lays it. Its front at +z is what lies ahead of
  /// the player, or the wall on which it hangs.
  std::string node(const std::string& family) const {
    const Direction wall = opposite(click_.face);
    const bool hangs = is_on_side() && is_on_wall(family);
    const Direction front = hangs ? wall : ahead();
    int quarters = 0;  // of a turn by which +z comes to +x
    if (front == Direction::pos_x) quarters = 1;
    if (front == Direction::neg_z) quarters = 2;
    if (front == Direction::neg_x) quarters = 3;
    Orientation lie = Orientation{}.rotated_about_y(quarters);
    const std::string_view path = std::string_view(family).substr(family.find(':') + 1);
    if (is_upper() && rule_names("stair_* slab_* trapdoor*", path)) lie = lie.mirrored(Axis::y);
    const auto name =
        turned_node_name(node_before(family),
                         {lie.along(Axis::x), lie.along(Axis::y), lie.along(Axis::z)}, lie.flips);
    return name && !name->empty() ? *name : family;
  }

 private:
  static bool is_any(std::string_view value, std::string_view a, std::string_view b) {
    return value == a || value == b;
  }
  static bool is_on_wall(std::string_view node) {
    return rule_names("torch_wall ladder* sign_wall*", node.substr(node.find(':') + 1));
  }
  /// A node whose front or wall is +z.
  static std::string node_before(const std::string& family) {
    return is_on_wall(family) ? family + "[param2=4]" : family;
  }

  void choose_facing(std::string_view path, MaterialStates& states) const {
    const std::string_view before = states.get("facing");
    Direction facing = opposite(ahead());
    if (rule_names(kFacingAway, path)) {
      facing = path == "observer" ? nearest_look(click_.look) : ahead();
    } else if (rule_names(kOnFace, path)) {
      facing = click_.face;
    } else if (rule_names(kOnWall, path) || path.ends_with("_trapdoor") || states.has("face")) {
      if (is_on_side()) facing = click_.face;
      if (states.has("face") && !is_on_side()) facing = ahead();
    } else if (path == "hopper") {
      facing = click_.face == Direction::neg_y ? Direction::neg_y : opposite(click_.face);
      if (facing == Direction::pos_y) facing = Direction::neg_y;
    } else if (rule_names("anvil chipped_anvil damaged_anvil", path)) {
      facing = right_of(ahead());
    } else if (rule_names("barrel dispenser dropper piston sticky_piston *command_block", path)) {
      facing = opposite(nearest_look(click_.look));
    }
    // Words of other games than this one are left alone.
    if (std::find(kFacingWords.begin(), kFacingWords.end(), before) != kFacingWords.end())
      states.states["facing"] = facing_word(facing);
  }

  const PlacedClick& click_;
};

}  // namespace

PlacedClick click_of(const Aim& aim) {
  RUNSTONE_ASSERT(aim.hit && aim.hit->face);
  PlacedClick out{*aim.hit->face, 0.5, aim.look};
  if (aim.hit->distance > 0) {
    const double y = aim.eye.y + aim.look.y * aim.hit->distance - aim.hit->voxel.y;
    out.height = std::clamp(y, 0.0, 1.0);
  }
  return out;
}

Material placed_material(Material held, const PlacedClick& click, const MaterialTable& table) {
  if (held == kEmpty || !table.knows(held)) return held;
  const MaterialStates before = states_of_material(table[held].name);
  const ClickStates chooses(click);
  if (is_shaped_node(table[held].name)) {
    MaterialStates wanted = states_of_material(chooses.node(before.family));
    if (wanted.states == before.states) return held;
    return nearest_member(table, wanted).value_or(held);
  }
  MaterialStates wanted = before;
  if (rule_names(kStandsOrHangs, before.path())) {
    // A torch that stands has other states than one that hangs on a wall.
    const bool hangs = chooses.is_on_side();
    const std::string other = standing_or_hanging(before.family, hangs);
    if (other != before.family && !table.family(other).empty()) wanted = states_of_material(other);
  }
  chooses.choose(wanted);
  if (wanted.family == before.family && wanted.states == before.states) return held;
  const auto nearest = nearest_member(table, wanted);
  if (!nearest) return held;
  // The held one is taken of members that differ as much.
  const auto differing = [&](Material material) {
    const MaterialStates states = states_of_material(table[material].name);
    return std::count_if(wanted.states.begin(), wanted.states.end(), [&](const auto& state) {
      return states.get(state.first) != state.second;
    });
  };
  return wanted.family == before.family && differing(held) <= differing(*nearest) ? held : *nearest;
}

}  // namespace runstone
