// WebWindows: the windows of the desktop client in a browser: tools, map, rollback and library. They
// are drawn on the canvas. Their font is a file that the page loads when a window is opened for the
// first time; until then, no window is drawn. Thread: the page's only one.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "client/input/input_router.hpp"
#include "client/panels/world_panels.hpp"
#include "client/ui/panel_windows.hpp"
#include "client/ui/ui_context.hpp"
#include "common/core/bytes.hpp"

namespace runstone {

class WebWindows {
 public:
  /// `keys` must outlive the object.
  explicit WebWindows(const KeyMap& keys) : windows_(keys) {}

  /// Opens or closes the window of an action; `release` closes one. Returns false if nothing
  /// happened.
  bool act(Action action);
  /// Takes the font. If it is empty, the windows have only the letters of Western Europe. `scale`
  /// is the size of the windows, see UiContext.
  void set_font(ByteView font, double scale);

  bool is_any_open() const { return windows_.is_any_open(); }
  ShownPanels shown() const { return shown_panels(windows_); }
  UiFocus focus() const;
  /// Returns true if a window is at this pixel of the frame.
  bool has_window_at(double x, double y) const;
  /// See UiContext.
  std::string field_text() const { return context_ ? context_->field_text() : std::string(); }
  void feed(const std::vector<InputEvent>& events);
  /// Makes the next frame of `size` pixels, `seconds` after the last one. Returns null if it has no
  /// window.
  std::shared_ptr<const OverlayFrame> make_frame(const HudState& state, std::array<int, 2> size,
                                                 double seconds);
  /// Returns what the user did since the last call.
  std::vector<UiAction> take_actions() { return std::exchange(actions_, {}); }

 private:
  PanelWindows windows_;
  std::optional<UiContext> context_;  // nullopt until set_font()
  bool is_font_requested_ = false;
  std::vector<UiAction> actions_;
};

}  // namespace runstone
