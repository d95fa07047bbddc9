#include "client/ui/panel_windows.hpp"

#include <utility>

namespace runstone {

bool PanelWindows::act(Action action) {
  switch (action) {
    case Action::tools:
      return tools_.toggle(), true;
    case Action::timeline:
      return timeline_.toggle(), true;
    case Action::play_log:
      return timeline_.toggle_play(), true;
    case Action::map:
      return map_.toggle(), true;
    case Action::rollback:
      return rollback_.toggle(), true;
    case Action::library:
      return library_.toggle(), true;
    default:
      return false;
  }
}

bool PanelWindows::close_one() {
  return tools_.close() || library_.close() || rollback_.close() || timeline_.close() ||
         map_.close();
}

bool PanelWindows::is_any_open() const { return has_fields() || map_.is_open(); }

bool PanelWindows::has_fields() const {
  return tools_.is_open() || rollback_.is_open() || library_.is_open() || timeline_.is_open();
}

unsigned PanelWindows::count_with_mouse() const {
  unsigned out = 0;
  for (const bool is_open : {map_.is_open(), timeline_.is_open(), rollback_.is_open(),
                             library_.is_open(), tools_.has_mouse()})
    out += is_open ? 1 : 0;
  return out;
}

bool PanelWindows::take_changed() {
  const std::array<bool, 4> open = {timeline_.is_open(), map_.is_open(), rollback_.is_open(),
                                    library_.is_open()};
  return std::exchange(open_, open) != open;
}

void PanelWindows::build(const HudState& state, UiContext& context, std::vector<UiAction>& out) {
  const double scale = context.scale();
  if (const auto moment = timeline_.build(state.timeline, scale)) out.emplace_back(*moment);
  map_.build(state.map, *state.materials, context);
  if (auto order = rollback_.build(state.rollback, scale)) out.emplace_back(*std::move(order));
  if (auto order = library_.build(state.library, context)) out.emplace_back(*std::move(order));
  std::vector<ToolCommand> commands;
  tools_.build(state, scale, commands);
  for (ToolCommand& command : commands) out.emplace_back(std::move(command));
  if (const auto time = tools_.take_time()) out.emplace_back(*time);
  if (auto wanted = tools_.file().take()) out.push_back(*std::move(wanted));
}

}  // namespace runstone
