// Client: the main thread of runstone-client while it plays on a server. It owns the session, the
// play and the script, and passes between them the results of the network thread, the mesh workers
// and the draw thread. Its loop never waits for a peer or for a frame. Each turn handles what has
// arrived. The next turn begins when more arrives (WakeUp), when a frame or the next poll of the
// window is due, or when the script is due.
#pragma once
#include <array>
#include <csignal>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/app/benchmark.hpp"
#include "client/app/client_display.hpp"
#include "client/app/client_end.hpp"
#include "client/app/client_hud.hpp"
#include "client/app/client_log.hpp"
#include "client/app/clipboard_transfer.hpp"
#include "client/app/game_menu.hpp"
#include "client/app/options.hpp"
#include "client/app/player_files.hpp"
#include "client/app/script_actions.hpp"
#include "client/app/terminal_chat.hpp"
#include "client/app/threaded_session.hpp"
#include "client/play/play.hpp"
#include "client/report/report.hpp"
#include "client/script/script_runner.hpp"

namespace runstone {

class Client {
 public:
  /// `script` and `menu` may be null; without a menu, escape ends the play. Both and `display` must
  /// outlive the client. Throws std::runtime_error if the key file cannot be read.
  Client(ClientOptions options, const Script* script, ClientDisplay& display,
         GameMenu* menu = nullptr);
  ~Client();

  /// Runs until the script, the user, the server, `stop` (set by a signal) or a failing driver ends
  /// the client. Then it sends a goodbye and writes the files of the options.
  ClientEnd run(const volatile std::sig_atomic_t& stop);

 private:
  /// Runs turns until the play ends. Throws std::runtime_error if drawing fails.
  ClientEnd run_turns(const volatile std::sig_atomic_t& stop);
  /// Logs what the server does not allow of the view of the options.
  void check_view() const;
  /// Takes the events of the window.
  void poll_window();
  /// Begins to read or write the files that the user wants, and takes what has become of them.
  void step_files(TimeUs now_us);
  /// Gives the events of the window, or of the script, to the player and to the interface.
  void handle_input(TimeUs now_us);
  /// Carries out an action of a key.
  void act(Action action, TimeUs now_us);
  void take_picture();
  /// Opens the pause menu. Requires menu_.
  void pause();
  /// Records how much of the distant ground is here.
  void look_at_horizon(TimeUs now_us);
  /// Gives what the player holds, and the kept hotbars, to player_files_ if they have changed.
  void keep_player(TimeUs now_us);
  /// Sends what is queued, and meshes what changed.
  void flush();
  /// Shows the notices and the new lines of the chat.
  void show_news();
  void draw(TimeUs now_us);
  /// Returns the size of a frame, in pixels.
  std::array<int, 2> frame_size() const;
  HudScene hud_scene() const;
  /// Draws as the settings say if the player changed them in this world.
  void use_look();
  /// Logs once that FXAA replaces an MSAA that the driver does not have.
  void log_antialiasing();
  /// Returns the settings in force.
  const ClientSettings& settings() const;
  PlaySettings play_settings() const;
  /// Returns the field of view of frames. Pictures of scripts do not depend on settings.
  std::optional<double> field_of_view() const;
  /// Returns how the play ends if it is to end now.
  std::optional<ClientEnd> end_of_play(TimeUs now_us);
  /// Gives the input to the menu if it is open. Returns true if it was.
  bool feed_menu(const WindowEvents& events);
  /// Carries out what the user chose in the menu, and closes the connecting screen when there is
  /// ground to see.
  void step_menu(TimeUs now_us);
  void rest(TimeUs now_us);
  /// Sends a goodbye, writes the files of the options and prints the table. Returns `code`, or
  /// kExitFailed if `code` is kExitOk and a file cannot be written.
  int finish(int code);
  ClientReport report() const;
  bool drift_found() const { return session_.replica().counters().drifted != 0; }

  const ClientOptions options_;
  WakeUp& wake_;  // of the display
  ThreadedSession network_;
  ClientSession& session_;          // of network_
  ClipboardFile* const clipboard_;  // of the display; may be null
  Window* const window_;            // of the display; null off screen
  GameMenu* const menu_;            // may be null
  ClientLog log_;
  PlayerFiles player_files_;  // play_ reads it
  Play play_;
  MeshPipeline& pipeline_;  // of play_
  HorizonRecorder horizon_;
  TimeUs horizon_due_us_ = 0;  // when it looks again
  TerminalChat chat_;
  ClientHud hud_;
  ClipboardTransfer files_;
  std::vector<ClipboardOfFile> dropped_;  // on the window, and not begun yet
  ScriptActions actions_;
  std::optional<ScriptRunner> runner_;
  std::optional<Benchmark> benchmark_;

  bool shows_players_ = false;  // the key for the list of players is held
  bool shows_ground_;           // the outlines of protected ground
  bool end_requested_ = false;  // by the user or a signal
  bool has_logged_antialiasing_ = false;
  bool is_left_ = false;  // the user goes back to the title screen
};

}  // namespace runstone
