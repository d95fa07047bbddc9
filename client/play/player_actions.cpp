#include "client/play/player_actions.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <utility>

namespace runstone {
namespace {

using KeyAnswer = Result<std::string, std::string>;

KeyAnswer choose_tool(EditTool& tool, const std::string& name) {
  static_cast<void>(tool.box().choose(name));
  return "tool: " + name;
}

/// Chooses the tool so many places further in the list.
KeyAnswer choose_from_here(EditTool& tool, std::size_t places) {
  ToolBox& box = tool.box();
  std::size_t i = 0;
  while (&box.tool() != box.tools()[i].get()) ++i;
  return choose_tool(tool, std::string(box.tools()[(i + places) % box.tools().size()]->name()));
}

KeyAnswer resize(EditTool& tool, int steps) {
  tool.box().change_size(steps);
  const std::string text = tool.text();
  return text.empty() ? "this tool has no size" : text;
}

KeyAnswer words(const Result<void, std::string>& done, const char* text) {
  if (!done) return failure(done.error());
  return std::string(text);
}

KeyAnswer turn_words(const ToolBox& box, const Result<void, std::string>& done, const char* text) {
  KeyAnswer out = words(done, text);
  if (out && !box.turn_notice().empty()) *out += ": " + box.turn_notice();
  return out;
}

KeyAnswer next_symmetry(EditTool& tool) {
  Symmetry next = tool.box().symmetry();
  const auto kind = (static_cast<unsigned>(next.kind) + 1) % 5;
  next.kind = static_cast<SymmetryKind>(kind);
  if (next.kind == SymmetryKind::x) {
    const auto hit = tool.aim().hit;
    if (!hit) return failure("look at the voxel in the middle of the symmetry first");
    next.centre2_x = 2 * hit->voxel.x;
    next.centre2_z = 2 * hit->voxel.z;
  }
  tool.box().set_symmetry(next);
  return next.kind == SymmetryKind::none ? "no symmetry" : tool.text();
}

/// Moves the mirror planes from the middle of their voxel to its border, or back.
KeyAnswer half_symmetry(EditTool& tool) {
  Symmetry next = tool.box().symmetry();
  if (next.kind == SymmetryKind::none) return failure("choose a symmetry first");
  // An odd number is the border behind a voxel.
  const std::int32_t shown = next.kind == SymmetryKind::z ? next.centre2_z : next.centre2_x;
  const bool is_middle = shown % 2 == 0;
  const auto moved_plane = [&](std::int32_t& centre2) {
    if ((centre2 % 2 == 0) == is_middle) centre2 += is_middle ? 1 : -1;
  };
  moved_plane(next.centre2_x);
  moved_plane(next.centre2_z);
  tool.box().set_symmetry(next);
  return std::string(is_middle ? "the mirror planes lie between voxels"
                               : "the mirror planes lie in the middle of voxels");
}

/// Returns the direction of the world into which an arrow key points for the player.
Direction nudge_direction(const LookDirection& look, Action action) {
  switch (action) {
    case Action::nudge_left:
      return opposite(horizontal_right(look));
    case Action::nudge_right:
      return horizontal_right(look);
    case Action::nudge_away:
      return horizontal_look(look);
    case Action::nudge_near:
      return opposite(horizontal_look(look));
    case Action::nudge_up:
      return Direction::pos_y;
    default:
      return Direction::neg_y;
  }
}

KeyAnswer nudge(EditTool& tool, Action action, TimeUs now_us) {
  const Direction direction = nudge_direction(tool.aim().look, action);
  return words(tool.propose(tool.box().nudge(tool.replica(), direction), now_us), "moved");
}

KeyAnswer turn_preview(EditTool& tool) {
  const bool is_shown = !tool.box().is_preview_shown();
  tool.box().show_preview(is_shown);
  return std::string(is_shown ? "previews are shown" : "previews are hidden");
}

}  // namespace

std::optional<Result<std::string, std::string>> act_on_tool(EditTool& tool, Action action,
                                                            TimeUs now_us) {
  ToolBox& box = tool.box();
  const Replica& replica = tool.replica();
  if (action >= Action::tool_1 && action <= Action::tool_10) {
    const auto i = static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::tool_1);
    return choose_tool(tool, std::string(box.tools()[i]->name()));
  }
  switch (action) {
    case Action::next_tool:
      return choose_from_here(tool, 1);
    case Action::previous_tool:
      return choose_from_here(tool, box.tools().size() - 1);
    case Action::larger:
      return resize(tool, 1);
    case Action::smaller:
      return resize(tool, -1);
    case Action::select:
      return choose_tool(tool, "select");
    case Action::copy:
      return words(box.copy(replica, true), "copied");
    case Action::cut:
      return words(tool.propose(box.cut(replica, true), now_us), "cut");
    case Action::paste:
      if (!box.clipboard().build) return KeyAnswer(failure("nothing was copied"));
      return choose_tool(tool, "paste");
    case Action::clear_selection:
      return words(tool.propose(box.fill(replica, kEmpty), now_us), "cleared");
    case Action::nudge_left:
    case Action::nudge_right:
    case Action::nudge_away:
    case Action::nudge_near:
    case Action::nudge_up:
    case Action::nudge_down:
      if (!replica.opened()) return KeyAnswer(failure("no world is open"));
      return nudge(tool, action, now_us);
    case Action::rotate:
      return turn_words(box, box.rotate(1), "the clipboard is turned");
    case Action::mirror:
      return turn_words(box, box.mirror(Axis::x), "the clipboard is mirrored");
    case Action::symmetry:
      return next_symmetry(tool);
    case Action::half_symmetry:
      return half_symmetry(tool);
    case Action::preview:
      return turn_preview(tool);
    default:
      return std::nullopt;
  }
}

std::optional<std::string> act_on_wheel(const WindowInput& input, EditTool& tool, Player& player,
                                        Hotbar& hotbar) {
  if (input.scroll == 0) return std::nullopt;
  if (input.resizes) {
    tool.box().change_size(input.scroll);
    return std::nullopt;
  }
  if (input.fast && !player.is_walking()) {
    player.change_flying_speed(input.scroll);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "flying speed: %g voxels a second",
                  player.flying_speed());
    return std::string(text.data());
  }
  hotbar.scroll(input.scroll);
  return std::nullopt;
}

}  // namespace runstone
