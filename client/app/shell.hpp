// Shell: runstone-client with a window, around the play on servers. It shows the title screen,
// starts servers of local worlds, plays, and comes back to the title screen with the reason if the
// play failed. One window and one OpenGL context serve all of it. Thread: the main thread.
#pragma once
#include <csignal>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "client/app/client_display.hpp"
#include "client/app/client_end.hpp"
#include "client/app/options.hpp"
#include "client/local/local_server.hpp"
#include "client/settings/settings_file.hpp"
#include "client/ui/menu.hpp"

namespace runstone {

class Shell {
 public:
  /// `display` has a window and must outlive the shell. The shell begins with the server or local
  /// world of the options, and otherwise with the title screen. The title screen shows the warnings
  /// of `loaded`.
  Shell(ClientOptions options, LoadedSettings loaded, std::string settings_file,
        ClientDisplay& display);

  /// Runs until the user or `stop` (set by a signal) ends the program. Returns the exit code.
  /// Throws std::runtime_error if drawing fails.
  int run(const volatile std::sig_atomic_t& stop);

 private:
  /// A server or local world to play on.
  struct Destination {
    ClientOptions options;
    std::string shown;                       // for the player
    std::optional<LocalServerConfig> local;  // start this server first
  };

  /// Shows the title screen until the user chose a destination or quits.
  void show_title(const volatile std::sig_atomic_t& stop);
  /// Reads the lists of servers and worlds and the identity again.
  void refresh();
  void carry_out(const MenuAction& action);
  /// Takes the name that the user typed, and keeps it. Returns false if it cannot be a name.
  bool take_name(const std::string& name);
  void join_address(const JoinAddress& chosen);
  void join_local(const std::string& world, const std::optional<NewLocalWorld>& creation);
  void use_settings(const ClientSettings& settings);

  /// Starts the server of a local world. Returns false if the user cancelled or it failed.
  bool start_local(Destination& to, const volatile std::sig_atomic_t& stop);
  void play(Destination to, const volatile std::sig_atomic_t& stop);
  void take_end(const ClientEnd& end);
  /// Checks if the server of the local world that was left has ended.
  void step_saving();
  /// Ends the server of the local world, and shows that it saves.
  void save_local();

  using MakeFrame =
      std::function<std::shared_ptr<const OverlayFrame>(std::array<int, 2> size, double seconds)>;
  /// Polls the window, draws a frame if one is due, and waits a moment.
  void turn(const MakeFrame& make_frame);

  ClientOptions options_;  // of the command line and the settings
  ClientSettings settings_;
  const std::string settings_file_;
  ClientDisplay& display_;
  std::unique_ptr<Menu> menu_;
  std::unique_ptr<LocalServer> local_;  // null unless a local world is played
  std::optional<Destination> next_;     // chosen, not played yet
  std::optional<Destination> last_;     // played last
  TitleState title_;
  bool quits_ = false;
  int exit_code_ = 0;
  bool is_frame_in_progress_ = false;
  int frames_wanted_ = 0;  // to draw without a pause, after input
  TimeUs drawn_us_ = 0;    // when the last frame was ordered
};

}  // namespace runstone
