#include "client/input/key_rows.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr ActionGroup kGroups[] = {ActionGroup::moving, ActionGroup::building, ActionGroup::others,
                                   ActionGroup::time, ActionGroup::window};

bool is_slot(Action action) {
  return action >= Action::hold_slot_1 && action <= Action::hold_slot_9;
}

bool slots_are_digits(const KeyMap& keys) {
  const KeyMap defaults;
  return std::ranges::all_of(action_table(), [&](const ActionInfo& row) {
    return !is_slot(row.action) || keys.keys_of(row.action) == defaults.keys_of(row.action);
  });
}

}  // namespace

std::vector<KeyRow> key_rows(const KeyMap& keys) {
  std::vector<KeyRow> rows;
  const bool joins_slots = slots_are_digits(keys);
  for (const ActionGroup group : kGroups) {
    if (group == ActionGroup::building) {
      for (const MouseInfo& mouse : mouse_table())
        rows.push_back({std::string(mouse.input), std::string(mouse.what), group});
    }
    for (const ActionInfo& row : action_table()) {
      if (row.group != group) continue;
      if (!joins_slots || !is_slot(row.action)) {
        rows.push_back({keys.keys_text(row.action), std::string(row.what), group});
      } else if (row.action == Action::hold_slot_1) {
        rows.push_back({"1 to 9", "take the material of that slot", group});
      }
    }
  }
  return rows;
}

}  // namespace runstone
