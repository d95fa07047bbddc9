// Client: the main thread of runstone-client while it plays on a server. It owns the session, the
// mesh pipeline and the script, and passes between them the results of the network thread, the mesh
// workers and the draw thread. Its loop never waits for a peer or for a frame. Each turn handles
// what has arrived. The next turn begins when more arrives (WakeUp), when a frame or the next poll
// of the window is due, or when the script is due.
#pragma once
#include <array>
#include <csignal>
#include <cstdint>
#include <optional>

#include "client/app/benchmark.hpp"
#include "client/app/change_notices.hpp"
#include "client/app/client_display.hpp"
#include "client/app/client_end.hpp"
#include "client/app/client_hud.hpp"
#include "client/app/game_menu.hpp"
#include "client/app/options.hpp"
#include "client/app/player_controls.hpp"
#include "client/app/player_log.hpp"
#include "client/app/preview_exchange.hpp"
#include "client/app/script_actions.hpp"
#include "client/app/terminal_chat.hpp"
#include "client/app/threaded_session.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/input/input_router.hpp"
#include "client/panels/world_panels.hpp"
#include "client/play/display_pace.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/frame_scene.hpp"
#include "client/play/player.hpp"
#include "client/play/view_follower.hpp"
#include "client/play/view_limits.hpp"
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
  void on_world_opened();
  /// Shows the materials that were added since the world was opened.
  void take_new_materials();
  void set_tool_materials(const MaterialTable& materials);
  /// Takes the events of the window.
  void poll_window();
  /// Gives the events of the window, or of the script, to the player and to the interface.
  void handle_input(TimeUs now_us);
  /// Opens the pause menu. Requires menu_.
  void pause();
  void follow_player(TimeUs now_us);
  /// Keeps the memory within the budget: shrinks the view, or lets it grow again, and bounds the
  /// meshes.
  void limit_memory(TimeUs now_us);
  /// Keeps the memory of tiles within their share of the budget.
  void limit_far_memory(TimeUs now_us);
  /// Records how much of the distant ground is here.
  void look_at_horizon(TimeUs now_us);
  /// Sends what is queued, and meshes what changed.
  void flush();
  /// Logs who came and left, once a second.
  void log_players(TimeUs now_us);
  void drain_changes();
  void draw(TimeUs now_us);
  /// Returns the size of a frame, in pixels.
  std::array<int, 2> frame_size() const;
  HudScene hud_scene() const;
  /// Draws with the quality of the settings if the player changed them in this world.
  void use_quality();
  /// Returns the settings in force.
  const ClientSettings& settings() const;
  Camera camera() const;
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
  ClientSession& session_;  // of network_
  Window* const window_;    // of the display; null off screen
  GameMenu* const menu_;    // may be null
  MeshPipeline pipeline_;
  Player player_;
  EditTool tool_;
  PreviewExchange previews_;
  InputRouter input_;
  HorizonRecorder horizon_;
  TimeUs horizon_due_us_ = 0;  // when it looks again
  ViewFollower view_;
  ViewLimits limits_;
  TerminalChat chat_;
  WorldPanels panels_;
  ClientHud hud_;
  ScriptActions actions_;
  PlayerControls controls_;
  FrameScene scene_;
  DisplayPace pace_;
  ChangeNotices notices_;
  std::optional<ScriptRunner> runner_;
  std::optional<Benchmark> benchmark_;

  TimeUs started_us_ = 0;
  TimeUs polled_us_ = 0;          // when the window was last polled
  std::optional<WorldId> world_;  // whose materials the hotbar has
  PlayerLog player_log_;
  TimeUs players_logged_us_ = 0;     // when the player log was last updated
  bool end_requested_ = false;       // by the user or a signal
  bool is_left_ = false;             // the user goes back to the title screen
  std::optional<TimeUs> opened_us_;  // when the first world of this client opened
};

}  // namespace runstone
