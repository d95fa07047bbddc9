// Hud: everything that the client shows over the world: the heads-up display, the chat, the palette
// and the other windows. Input events and a HudState come in; overlay frames and actions of the
// user come out. It needs no window and no OpenGL. One thread.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/input/input_router.hpp"
#include "client/ui/chat_window.hpp"
#include "client/ui/help_window.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/notice_list.hpp"
#include "client/ui/palette_window.hpp"
#include "client/ui/panel_windows.hpp"
#include "client/ui/ui_action.hpp"
#include "client/ui/ui_context.hpp"

namespace runstone {

class Hud {
 public:
  explicit Hud(const KeyMap& keys, double scale = 1);

  void feed(const std::vector<InputEvent>& events) { context_.feed(events); }
  /// Carries out an action that opens or closes a window. Returns false if the action is none, or
  /// if it is `release` and no window is open.
  bool act(Action action);
  /// Returns which of the next events the interface takes.
  UiFocus focus() const;
  void notify(std::string text, NoticeKind kind = NoticeKind::information);
  /// Adds a line to the chat.
  void hear(ShownLine line);
  /// Removes lines from the chat.
  void withdraw(const std::vector<ChatLineId>& lines);

  /// Makes the next frame of `size` pixels, `seconds` after the last one.
  std::shared_ptr<const OverlayFrame> make_frame(const HudState& state, std::array<int, 2> size,
                                                 double seconds);
  /// Returns what the user did since the last call.
  std::vector<UiAction> take_actions() { return std::exchange(actions_, {}); }
  /// Returns true if the next frame differs from the last one even without an event: something
  /// fades.
  bool is_moving() const;
  bool shows_statistics() const { return shows_statistics_; }
  PanelWindows& panels() { return panels_; }
  const PanelWindows& panels() const { return panels_; }

 private:
  void build(const HudState& state);
  /// Closes the window that was opened last. Returns false if none is open.
  bool close_top();
  /// Returns true while a text field was opened and does not have the keyboard yet.
  bool takes_focus() const;
  /// Returns true if a window is open in which the keyboard can choose and press buttons.
  bool has_window() const;

  KeyMap keys_;
  UiContext context_;
  NoticeList notices_;
  ChatWindow chat_;
  PaletteWindow palette_;
  PanelWindows panels_{keys_};
  bool has_news_ = false;       // since the last frame
  bool uses_keyboard_ = false;  // windows take the keyboard
  HelpWindow help_;
  bool shows_statistics_ = false;
  std::vector<UiAction> actions_;
  double name_seconds_ = kLong;  // since the held material changed
  Material held_ = 0;            // of the last frame
  static constexpr double kLong = 1e9;
};

}  // namespace runstone
