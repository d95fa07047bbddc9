#include "client/input/key_rows.hpp"

#include <algorithm>
#include <span>

namespace runstone {
namespace {

constexpr ActionGroup kGroups[] = {ActionGroup::moving, ActionGroup::building, ActionGroup::others,
                                   ActionGroup::time, ActionGroup::window};

/// Actions that are one row of the table while they have their default keys.
struct JoinedRow {
  Action first, last;
  const char* input;
  const char* what;
};
constexpr JoinedRow kJoinedRows[] = {
    {Action::hold_slot_1, Action::hold_slot_9, "1 to 9", "take the material of that slot"},
    {Action::tool_1, Action::tool_10, "ctrl+1 to ctrl+9, ctrl+0", "choose that tool of the list"},
};

/// Returns the joined row that has this action, or null.
const JoinedRow* joined_row(const KeyMap& keys, Action action) {
  static const KeyMap defaults;
  const std::span<const ActionInfo> all = action_table();
  for (const JoinedRow& row : kJoinedRows) {
    if (action < row.first || action > row.last) continue;
    const bool are_default = std::all_of(all.begin(), all.end(), [&](const ActionInfo& info) {
      return info.action < row.first || info.action > row.last ||
             keys.keys_of(info.action) == defaults.keys_of(info.action);
    });
    return are_default ? &row : nullptr;
  }
  return nullptr;
}

}  // namespace

std::vector<KeyRow> key_rows(const KeyMap& keys) {
  std::vector<KeyRow> rows;
  for (const ActionGroup group : kGroups) {
    if (group == ActionGroup::building) {
      for (const MouseInfo& mouse : mouse_table())
        rows.push_back({std::string(mouse.input), std::string(mouse.what), group});
    }
    for (const ActionInfo& row : action_table()) {
      if (row.group != group) continue;
      const JoinedRow* const joined = joined_row(keys, row.action);
      if (joined == nullptr) {
        rows.push_back({keys.keys_text(row.action), std::string(row.what), group});
      } else if (row.action == joined->first) {
        rows.push_back({joined->input, joined->what, group});
      }
    }
  }
  return rows;
}

}  // namespace runstone
