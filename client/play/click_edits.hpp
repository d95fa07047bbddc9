// ClickEdits: passes the buttons of the mouse to the tool of the player. One thread.
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

  /// Carries out presses of the left and the right button. `releases`: a button that is not held
  /// counts as released, so a tool that waits for the release acts. Returns for each refused edit
  /// the reason, in words for the player.
  std::vector<std::string> step(const WindowInput& input, bool releases, TimeUs now_us);

 private:
  EditTool& tool_;
  HeldButton remove_button_, place_button_;
};

}  // namespace runstone
