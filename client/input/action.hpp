// Action: something that a key does. The table of actions is the only place that names them: the
// key map, the help window, the settings and the table in docs/client.md follow it.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace runstone {

enum class Action : std::uint8_t {
  // Held keys.
  move_forward,
  move_left,
  move_back,
  move_right,
  move_up,
  move_down,
  move_fast,
  show_players,
  resize,
  // Pressed keys.
  walk_or_fly,
  hold_slot_1,
  hold_slot_2,
  hold_slot_3,
  hold_slot_4,
  hold_slot_5,
  hold_slot_6,
  hold_slot_7,
  hold_slot_8,
  hold_slot_9,
  palette,
  undo,
  redo,
  tools,
  tool_1,
  tool_2,
  tool_3,
  tool_4,
  tool_5,
  tool_6,
  tool_7,
  tool_8,
  tool_9,
  tool_10,
  next_tool,
  previous_tool,
  larger,
  smaller,
  select,
  copy,
  cut,
  paste,
  clear_selection,
  nudge_left,
  nudge_right,
  nudge_away,
  nudge_near,
  nudge_up,
  nudge_down,
  rotate,
  mirror,
  symmetry,
  half_symmetry,
  preview,
  stop_building,
  library,
  chat,
  command,
  map,
  rollback,
  timeline,
  earlier,
  later,
  live,
  play_log,
  help,
  screenshot,
  statistics,
  interface,
  ground,
  inspect_wireframe,
  inspect_runs,
  inspect_orders,
  inspect_layers,
  keyboard,
  release,
};
/// The slots of the hotbar, each with an action hold_slot_N.
inline constexpr std::size_t kSlotCount = 9;
inline constexpr std::size_t kActionCount = static_cast<std::size_t>(Action::release) + 1;

enum class ActionGroup : std::uint8_t { moving, building, others, time, window };

struct ActionInfo {
  Action action{};
  std::string_view name;  // in settings and scripts
  std::string_view what;  // the effect, for people
  ActionGroup group{};
  std::string_view default_keys;  // chords as parse_key_chord() reads them, with blanks between
  bool is_held = false;           // acts while the key is down; it is found by its place
};

/// Returns the rows in the order of Action.
std::span<const ActionInfo> action_table();
const ActionInfo& info_of(Action action);
std::string_view title_of(ActionGroup group);

/// A row of the help window and of docs/client.md: an input that is no key.
struct MouseInfo {
  std::string_view input, what;
};
std::span<const MouseInfo> mouse_table();

}  // namespace runstone
