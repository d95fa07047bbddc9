#include "client/input/action.hpp"

#include <array>

namespace runstone {
namespace {

using enum ActionGroup;

constexpr std::array<ActionInfo, kActionCount> kTable = {{
    {Action::move_forward, "move_forward", "move forward", moving, "W", true},
    {Action::move_left, "move_left", "move to the left", moving, "A", true},
    {Action::move_back, "move_back", "move back", moving, "S", true},
    {Action::move_right, "move_right", "move to the right", moving, "D", true},
    {Action::move_up, "move_up", "fly up, jump, swim up", moving, "space", true},
    {Action::move_down, "move_down", "fly down, or walk and stay on the edge", moving, "shift",
     true},
    {Action::move_fast, "move_fast", "fly faster, run", moving, "control", true},
    {Action::show_players, "show_players", "show who is here, while held", others, "tab", true},
    {Action::resize, "resize", "let the wheel change the size of the tool, while held", building,
     "alt", true},
    {Action::walk_or_fly, "walk_or_fly", "walk, or fly again", moving, "F"},
    {Action::hold_slot_1, "hold_slot_1", "take the material of slot 1", building, "1"},
    {Action::hold_slot_2, "hold_slot_2", "take the material of slot 2", building, "2"},
    {Action::hold_slot_3, "hold_slot_3", "take the material of slot 3", building, "3"},
    {Action::hold_slot_4, "hold_slot_4", "take the material of slot 4", building, "4"},
    {Action::hold_slot_5, "hold_slot_5", "take the material of slot 5", building, "5"},
    {Action::hold_slot_6, "hold_slot_6", "take the material of slot 6", building, "6"},
    {Action::hold_slot_7, "hold_slot_7", "take the material of slot 7", building, "7"},
    {Action::hold_slot_8, "hold_slot_8", "take the material of slot 8", building, "8"},
    {Action::hold_slot_9, "hold_slot_9", "take the material of slot 9", building, "9"},
    {Action::palette, "palette", "choose a material for the slot from all of them", building, "E"},
    {Action::undo, "undo", "undo your newest action", building, "ctrl+Z"},
    {Action::redo, "redo", "redo it", building, "ctrl+Y ctrl+shift+Z"},
    {Action::tools, "tools", "show or hide the tools with their numbers", building, "Q"},
    {Action::tool_1, "tool_1", "choose tool 1 of the list", building, "ctrl+1"},
    {Action::tool_2, "tool_2", "choose tool 2 of the list", building, "ctrl+2"},
    {Action::tool_3, "tool_3", "choose tool 3 of the list", building, "ctrl+3"},
    {Action::tool_4, "tool_4", "choose tool 4 of the list", building, "ctrl+4"},
    {Action::tool_5, "tool_5", "choose tool 5 of the list", building, "ctrl+5"},
    {Action::tool_6, "tool_6", "choose tool 6 of the list", building, "ctrl+6"},
    {Action::tool_7, "tool_7", "choose tool 7 of the list", building, "ctrl+7"},
    {Action::tool_8, "tool_8", "choose tool 8 of the list", building, "ctrl+8"},
    {Action::tool_9, "tool_9", "choose tool 9 of the list", building, "ctrl+9"},
    {Action::tool_10, "tool_10", "choose tool 10 of the list", building, "ctrl+0"},
    {Action::next_tool, "next_tool", "choose the next tool", building, "page_down"},
    {Action::previous_tool, "previous_tool", "choose the tool before", building, "page_up"},
    {Action::larger, "larger", "make the tool larger", building, "equal"},
    {Action::smaller, "smaller", "make the tool smaller", building, "minus"},
    {Action::select, "select", "choose the tool that selects", building, "B"},
    {Action::copy, "copy", "copy the selection", building, "ctrl+C"},
    {Action::cut, "cut", "copy the selection and clear it", building, "ctrl+X"},
    {Action::paste, "paste", "choose the tool that pastes", building, "ctrl+V"},
    {Action::clear_selection, "clear_selection", "clear the selection", building, "delete"},
    {Action::nudge_left, "nudge_left", "move what you just pasted to the left", building, "left"},
    {Action::nudge_right, "nudge_right", "move it to the right", building, "right"},
    {Action::nudge_away, "nudge_away", "move it away from you", building, "up"},
    {Action::nudge_near, "nudge_near", "move it towards you", building, "down"},
    {Action::nudge_up, "nudge_up", "move it up", building, "shift+up"},
    {Action::nudge_down, "nudge_down", "move it down", building, "shift+down"},
    {Action::rotate, "rotate", "turn the clipboard by a quarter", building, "R"},
    {Action::mirror, "mirror", "mirror the clipboard along x", building, "X"},
    {Action::symmetry, "symmetry", "choose the next symmetry, about the voxel in sight", building,
     "Y"},
    {Action::half_symmetry, "half_symmetry",
     "mirror at the border of a voxel, or in its middle again", building, "shift+Y"},
    {Action::preview, "preview", "show or hide what the next click does", building, "P"},
    {Action::stop_building, "stop_building", "stop the fill, paste, move or mix under way",
     building, "backspace"},
    {Action::library, "library", "show or hide the library of builds", building, "L"},
    {Action::chat, "chat", "write to all players", others, "T enter"},
    {Action::command, "command", "write a command for the server", others, "slash"},
    {Action::map, "map", "show or hide the map from above", others, "M"},
    {Action::rollback, "rollback", "show or hide the window that takes back the edits of others",
     others, "ctrl+H"},
    {Action::timeline, "timeline", "show or hide the timeline", time, "H"},
    {Action::earlier, "earlier", "go back by a hundredth of the log", time, "["},
    {Action::later, "later", "go forth by a hundredth of the log", time, "]"},
    {Action::live, "live", "return to the live world", time, "home"},
    {Action::play_log, "play_log", "play the log from the shown moment on, or pause", time,
     "ctrl+P"},
    {Action::help, "help", "show or hide this help", window, "F1"},
    {Action::screenshot, "screenshot", "write a picture to a file", window, "F2"},
    {Action::statistics, "statistics", "show or hide the measurements", window, "F3"},
    {Action::interface, "interface", "hide or show everything but the world", window, "F4"},
    {Action::ground, "ground", "show or hide the outlines of protected ground", window, "G"},
    {Action::inspect_wireframe, "inspect_wireframe", "show or hide the edges of quads", window,
     "F5"},
    {Action::inspect_runs, "inspect_runs", "show or hide where stored runs end", window, "F6"},
    {Action::inspect_orders, "inspect_orders", "show or hide the axis orders of chunks", window,
     "F7"},
    {Action::inspect_layers, "inspect_layers", "show or hide layers as they are meshed again",
     window, "F8"},
    {Action::keyboard, "keyboard",
     "let the keyboard work the open windows, or move the player again", window, "F9"},
    {Action::release, "release", "close a window; otherwise open the menu", window, "escape"},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kTable.size(); ++i) {
    if (kTable[i].action != static_cast<Action>(i)) return false;
  }
  return true;
}
static_assert(is_in_order());

constexpr std::array<MouseInfo, 5> kMouse = {{
    {"click", "captures the mouse"},
    {"left button", "remove with the tool; held down, again and again by the voxel tool"},
    {"right button", "place with the tool; held down, again and again by the voxel tool"},
    {"middle button", "take the material of the voxel in sight"},
    {"wheel", "choose the slot; while you fly faster, change the speed of flight"},
}};

}  // namespace

std::span<const ActionInfo> action_table() { return kTable; }

const ActionInfo& info_of(Action action) { return kTable[static_cast<std::size_t>(action)]; }

std::string_view title_of(ActionGroup group) {
  switch (group) {
    case moving:
      return "Moving";
    case building:
      return "Building";
    case others:
      return "With others";
    case ActionGroup::time:
      return "Time";
    case window:
      return "Window";
  }
  return "";
}

std::span<const MouseInfo> mouse_table() { return kMouse; }

}  // namespace runstone
