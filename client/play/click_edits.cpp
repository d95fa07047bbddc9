#include "client/play/click_edits.hpp"

#include <optional>

namespace runstone {

std::vector<std::string> ClickEdits::step(const WindowInput& input, bool releases, TimeUs now_us) {
  std::vector<std::string> refused;
  const auto note = [&refused](const Result<void, std::string>& done) {
    if (!done) refused.push_back(done.error());
  };
  std::optional<SelectMode> mode;
  if (input.fast) mode = SelectMode::add;
  if (input.resizes) mode = SelectMode::remove;
  tool_.box().hold_select_mode(mode);
  const bool repeats = tool_.repeats();
  int acts = remove_button_.acts(input.remove_clicks, input.remove_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::clear, now_us));
  acts = place_button_.acts(input.place_clicks, input.place_held && repeats, now_us);
  while (acts-- > 0) note(tool_.press(ToolButton::place, now_us));
  if (input.remove_held || input.place_held) {
    tool_.drag();
  } else if (releases || input.remove_clicks + input.place_clicks != 0) {
    note(tool_.release(now_us));
  }
  return refused;
}

}  // namespace runstone
