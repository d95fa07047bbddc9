#include "client/ui/hud.hpp"

#include "client/input/key_rows.hpp"
#include "client/ui/heads_up.hpp"
#include "client/ui/inspection_panel.hpp"
#include "client/ui/player_list.hpp"
#include "client/ui/statistics_window.hpp"

namespace runstone {

Hud::Hud(const KeyMap& keys, double scale) : keys_(keys), context_(scale) {}

bool Hud::act(Action action) {
  switch (action) {
    case Action::chat:
    case Action::command:
      palette_.close();
      chat_.open(action == Action::command ? "/" : "");
      return true;
    case Action::palette:
      if (palette_.is_open()) {
        palette_.close();
      } else {
        palette_.open();
      }
      return true;
    case Action::help:
      help_.toggle();
      return true;
    case Action::next_tool:
    case Action::previous_tool:
      if (!help_.is_open()) return false;
      help_.scroll(action == Action::next_tool ? 1 : -1);
      return true;
    case Action::keyboard:
      if (!has_window()) return notify("open a window first"), true;
      uses_keyboard_ = !uses_keyboard_;
      context_.set_keyboard(uses_keyboard_);
      if (uses_keyboard_) context_.focus_window();
      return true;
    case Action::statistics:
      shows_statistics_ = !shows_statistics_;
      return true;
    case Action::release:
      return close_top();
    default:
      return panels_.act(action);
  }
}

bool Hud::close_top() {
  if (chat_.is_open()) return chat_.close(), true;
  if (palette_.is_open()) return palette_.close(), true;
  return help_.close() || panels_.close_one() || std::exchange(shows_statistics_, false);
}

bool Hud::has_window() const {
  return palette_.is_open() || shows_statistics_ || panels_.is_any_open();
}

bool Hud::takes_focus() const { return chat_.takes_focus() || palette_.takes_focus(); }

UiFocus Hud::focus() const {
  UiFocus out;
  out.has_window = chat_.is_open() || palette_.is_open();
  // ImGui still names a text field whose window was closed after the last frame.
  const bool has_fields = out.has_window || panels_.has_fields();
  out.types = uses_keyboard_ || (has_fields && (context_.types() || takes_focus()));
  out.over_window = context_.over_window();
  out.panels = panels_.count_with_mouse() + (help_.is_open() ? 1U : 0U) +
               (shows_statistics_ ? 1U : 0U) + (uses_keyboard_ ? 1U : 0U);
  out.scrolls = help_.is_open();
  return out;
}

void Hud::notify(std::string text, NoticeKind kind) {
  notices_.add(std::move(text), kind);
  has_news_ = true;
}

void Hud::hear(ShownLine line) {
  chat_.hear(std::move(line));
  has_news_ = true;
}

void Hud::withdraw(const std::vector<ChatLineId>& lines) {
  if (chat_.withdraw(lines) != 0) has_news_ = true;
}

std::shared_ptr<const OverlayFrame> Hud::make_frame(const HudState& state, std::array<int, 2> size,
                                                    double seconds) {
  has_news_ = false;
  if (!has_window() && std::exchange(uses_keyboard_, false)) context_.set_keyboard(false);
  notices_.advance(seconds);
  chat_.advance(seconds);
  name_seconds_ += seconds;
  const Material held = state.slots[state.slot];
  if (std::exchange(held_, held) != held) name_seconds_ = 0;
  const auto make = [&] { build(state); };
  // ImGui knows the height of a window only after it was made once.
  if (panels_.take_changed()) context_.make_hidden_frame(size, make);
  for (int i = 0; i < UiContext::kFocusFrames && takes_focus(); ++i)
    context_.make_hidden_frame(size, make);
  return context_.make_frame(size, seconds, make);
}

bool Hud::is_moving() const {
  const double name_left = kSlotNameSeconds - name_seconds_;
  const bool name_fades = name_left > 0 && (name_left < kSlotNameFadeSeconds || name_seconds_ == 0);
  return has_news_ || name_fades || panels_.timeline().is_playing() || notices_.is_fading() ||
         chat_.is_fading();
}

void Hud::build(const HudState& state) {
  const double top = build_heads_up(state, name_seconds_, context_.scale());
  const double scale = context_.scale();
  if (chat_.is_open()) chat_.set_names(state.names);
  if (auto line = chat_.build(top, scale)) actions_.emplace_back(SendLine{*std::move(line)});
  if (state.shows_players) build_player_list(state, scale);
  build_inspection_legend(state.inspection, scale);
  if (shows_statistics_) {
    InspectionModes modes = state.inspection;
    build_statistics(state.statistics, keys_, scale, modes, shows_statistics_);
    if (modes != state.inspection) actions_.emplace_back(SetInspection{modes});
  }
  panels_.build(state, context_, actions_);
  help_.build(key_rows(keys_));
  palette_.build(state, scale, actions_);
  notices_.build(top, scale);
}

}  // namespace runstone
