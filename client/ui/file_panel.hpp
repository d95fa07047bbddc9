// FilePanel: the part of the tool window for files of the clipboard. The user chooses a file to
// read or to write. If the file holds a model, the user also chooses how it becomes voxels. The
// panel does not open files: it returns the order of the user. One thread.
#pragma once
#include <optional>
#include <string>
#include <utility>

#include "client/ui/hud_state.hpp"
#include "client/ui/ui_action.hpp"
#include "common/models/model_choices.hpp"

namespace runstone {

class FilePanel {
 public:
  /// Builds the widgets with ImGui. Returns true if the user orders a copy of the selection first.
  bool build(const HudState& state);
  /// Takes a file that was dropped on the window. Returns the order to read it with the choices
  /// that the panel shows.
  ClipboardOfFile drop(std::string file);
  /// Returns the order that the user gave since the last call, or nullopt if there is none.
  std::optional<UiAction> take() { return std::exchange(wanted_, std::nullopt); }

 private:
  void build_progress(const FileState& file);
  void build_choices();
  /// Returns why a model cannot be read with these choices, or an empty text.
  std::string refusal() const;
  ModelChoices choices() const;

  std::string file_;    // a path, as typed
  ModelChoices model_;  // its size is in the next three members
  int voxels_ = kModelVoxelsUsual;
  double voxels_per_metre_ = 1;
  bool is_by_metres_ = false;
  std::optional<UiAction> wanted_;
};

}  // namespace runstone
