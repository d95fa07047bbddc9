// ClickEdits: works the tool of the player by the buttons of the mouse. One thread.
#pragma once
#include <string>
#include <vector>

#include "client/input/window_input.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/held_button.hpp"
#include "common/core/ids.hpp"

namespace runstone {

class ClickEdits {
 public:
  /// `tool` must outlive the object.
  explicit ClickEdits(EditTool& tool) : tool_(tool) {}

  /// Carries out the buttons of the left and the right side. `releases`: a button that is not held
  /// counts as released, so the tool acts that waits for it. Returns the reasons of what was
  /// refused, in words for the player.
  std::vector<std::string> step(const WindowInput& input, bool releases, TimeUs now_us);

 private:
  EditTool& tool_;
  HeldButton remove_button_, place_button_;
};

}  // namespace runstone
