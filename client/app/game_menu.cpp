#include "client/app/game_menu.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace runstone {

GameMenu::GameMenu(Menu& menu, std::string to, bool is_local,
                   std::function<void(const ClientSettings&)> keep)
    : menu_(menu), to_(std::move(to)), is_local_(is_local), keep_(std::move(keep)) {
  menu_.reset();
}

void GameMenu::pause() {
  menu_.reset();
  is_paused_ = true;
}

void GameMenu::feed(const std::vector<InputEvent>& events) {
  const bool has_escape = std::ranges::any_of(events, [](const InputEvent& event) {
    if (const auto* const pad = std::get_if<GamepadButtonEvent>(&event))
      return pad->is_pressed && pad->button == GamepadButton::start;
    const auto* const key = std::get_if<KeyEvent>(&event);
    return key != nullptr && key->is_pressed && !key->is_repeat && key->place == Key::escape;
  });
  if (has_escape && is_paused_) resume();
  menu_.feed(events);
}

std::shared_ptr<const OverlayFrame> GameMenu::make_frame(ConnectingState connecting,
                                                         PauseState pause, std::array<int, 2> size,
                                                         TimeUs now_us) {
  const double seconds = static_cast<double>(now_us - std::exchange(made_us_, now_us)) / 1e6;
  connecting.to = pause.where = to_;
  pause.is_local = is_local_;
  auto frame =
      is_paused_ ? menu_.pause(pause, size, seconds) : menu_.connecting(connecting, size, seconds);
  for (const MenuAction& action : menu_.take_actions()) carry_out(action);
  return frame;
}

void GameMenu::resume() {
  is_paused_ = false;
  is_resumed_ = true;
  menu_.reset();
}

void GameMenu::carry_out(const MenuAction& action) {
  if (std::holds_alternative<ResumePlay>(action)) resume();
  if (std::holds_alternative<CancelJoin>(action)) choice_ = PlayChoice::leave;
  if (std::holds_alternative<LeaveServer>(action)) choice_ = PlayChoice::leave;
  if (std::holds_alternative<QuitProgram>(action)) choice_ = PlayChoice::quit;
  if (const auto* changed = std::get_if<ChangeSettings>(&action)) {
    settings_ = changed->settings;
    keep_(changed->settings);
  }
}

}  // namespace runstone
