// Menu: the screens around the game: title, connecting, pause and settings. Input events and a
// state come in; overlay frames and actions of the user come out. It needs no window and no OpenGL.
// One thread.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "client/ui/menu_action.hpp"
#include "client/ui/menu_state.hpp"
#include "client/ui/settings_form.hpp"
#include "client/ui/ui_context.hpp"

namespace runstone {

class Menu {
 public:
  /// The size of text and windows follows settings.interface_scale.
  explicit Menu(const ClientSettings& settings);

  void feed(const std::vector<InputEvent>& events) { context_.feed(events); }
  /// The next three functions return the overlay of a frame of `size` pixels, `seconds` after the
  /// last one.
  std::shared_ptr<const OverlayFrame> title(const TitleState& state, std::array<int, 2> size,
                                            double seconds);
  std::shared_ptr<const OverlayFrame> connecting(const ConnectingState& state,
                                                 std::array<int, 2> size, double seconds);
  std::shared_ptr<const OverlayFrame> pause(const PauseState& state, std::array<int, 2> size,
                                            double seconds);
  /// Closes the settings without keeping them, and forgets a typed password. Call it when another
  /// screen comes.
  void reset();
  /// Returns what the user did since the last call.
  std::vector<MenuAction> take_actions() { return std::exchange(actions_, {}); }

 private:
  enum class Screen : std::uint8_t { none, title, password, settings, connecting, pause };
  /// If `screen` has just come, it has its first button chosen before it takes events.
  std::shared_ptr<const OverlayFrame> make_frame(Screen screen, std::array<int, 2> size,
                                                 double seconds,
                                                 const std::function<void()>& build);
  void build_title(const TitleState& state, std::array<int, 2> size);
  void build_servers(const TitleState& state);
  void build_worlds(const TitleState& state);
  void build_failure(const ShownFailure& failure);
  void build_password(const std::string& address, std::array<int, 2> size);
  void build_connecting(const ConnectingState& state, std::array<int, 2> size);
  void build_pause(const PauseState& state, std::array<int, 2> size);
  void build_settings(std::array<int, 2> size);
  void join(std::string address);

  UiContext context_;
  ClientSettings settings_;
  SettingsForm form_;
  Screen shown_ = Screen::none;  // by the last frame
  bool shows_settings_ = false;
  std::string address_, name_, password_, world_, seed_;
  int generator_ = 0;
  bool has_name_ = false;  // the name was taken from the state, or typed
  std::vector<MenuAction> actions_;
};

}  // namespace runstone
