// FilePanel: the part of the tool window in which the clipboard is read from a file or written to
// one. It asks how a model becomes voxels, if the file has one. It reads nothing itself: it returns
// what the user wants. One thread.
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
  /// Makes the part with ImGui. Returns true if the user wants the selection to be copied first.
  bool build(const HudState& state);
  /// Takes a file that was dropped on the window. Returns the order to read it, with the choices
  /// that the panel shows.
  ClipboardOfFile drop(std::string file);
  /// Returns what the user wants, once.
  std::optional<UiAction> take() { return std::exchange(wanted_, std::nullopt); }

 private:
  void build_progress(const FileState& file);
  void build_choices();
  /// Returns why a model cannot be read with these choices, or an empty text.
  std::string refusal() const;
  ModelChoices choices() const;

  std::string file_;    // a path, as typed
  ModelChoices model_;  // but for its size
  int voxels_ = kModelVoxelsUsual;
  double voxels_per_metre_ = 1;
  bool is_by_metres_ = false;
  std::optional<UiAction> wanted_;
};

}  // namespace runstone
