// GameMenu: the screens over the game on one server: connecting, until there is ground to see, and
// the pause menu. It passes the input to the menu while one of them is open. One thread.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/ui/menu.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// How the user ends the play.
enum class PlayChoice : std::uint8_t { leave, quit };

class GameMenu {
 public:
  /// `menu` must outlive this object. `to` is the name of the server or world for the player.
  /// `keep` is called when the user changed the settings.
  GameMenu(Menu& menu, std::string to, bool is_local,
           std::function<void(const ClientSettings&)> keep);

  const std::string& to() const { return to_; }
  bool is_connecting() const { return is_connecting_; }
  /// Ends the connecting screen.
  void set_joined() { is_connecting_ = false; }
  bool is_open() const { return is_connecting_ || is_paused_; }
  void pause();
  /// Takes input while is_open(). Escape, or `start` of the gamepad, ends the pause.
  void feed(const std::vector<InputEvent>& events);
  /// Makes the overlay of a frame. Requires is_open(). The fields `to` and `where` are filled in.
  std::shared_ptr<const OverlayFrame> make_frame(ConnectingState connecting, PauseState pause,
                                                 std::array<int, 2> size, TimeUs now_us);
  /// Returns true if the user ended the pause since the last call.
  bool take_resumed() { return std::exchange(is_resumed_, false); }
  /// Returns how the user wants to end the play, or nullopt.
  std::optional<PlayChoice> choice() const { return choice_; }
  /// Returns the settings that the user changed last, or nullopt.
  const std::optional<ClientSettings>& settings() const { return settings_; }

 private:
  void carry_out(const MenuAction& action);
  void resume();

  Menu& menu_;
  const std::string to_;
  const bool is_local_;
  const std::function<void(const ClientSettings&)> keep_;
  bool is_connecting_ = true, is_paused_ = false, is_resumed_ = false;
  std::optional<PlayChoice> choice_;
  std::optional<ClientSettings> settings_;
  TimeUs made_us_ = 0;  // when the last frame was made
};

}  // namespace runstone
