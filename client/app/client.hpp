// Client: the main thread of runstone-client. It owns the session, the window, the mesh pipeline
// and the script, and passes between them the results of the network thread, the mesh workers and
// the draw thread. Its loop never waits for a peer or for a frame. Each turn handles what has
// arrived. The next turn begins when more arrives (WakeUp), when a frame or the next poll of the
// window is due, or when the script is due.
#pragma once
#include <csignal>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/app/edit_tool.hpp"
#include "client/app/held_button.hpp"
#include "client/app/options.hpp"
#include "client/app/player.hpp"
#include "client/app/player_log.hpp"
#include "client/app/script_actions.hpp"
#include "client/app/terminal_chat.hpp"
#include "client/app/threaded_session.hpp"
#include "client/app/view_follower.hpp"
#include "client/body/shown_space.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/net/wake_up.hpp"
#include "client/platform/window.hpp"
#include "client/report/report.hpp"
#include "client/schedule/memory_budget.hpp"
#include "client/script/script_runner.hpp"

namespace runstone {

class Client {
 public:
  /// `script` may be null and must outlive the client. Throws std::runtime_error if OpenGL is
  /// missing or the key file cannot be read.
  Client(ClientOptions options, const Script* script);
  ~Client();

  /// Runs until the script, the user, the server, `stop` (set by a signal) or a failing driver ends
  /// the client. Then it sends a goodbye and writes the files of the options. Returns the exit
  /// code.
  int run(const volatile std::sig_atomic_t& stop);

 private:
  /// Runs turns until the program ends; returns the exit code. Throws std::runtime_error if drawing
  /// fails.
  int run_turns(const volatile std::sig_atomic_t& stop);
  void on_world_opened();
  /// Shows the materials that were added since the world was opened.
  void take_new_materials();
  void poll_window(TimeUs now_us);
  void edit_with(const WindowInput& input, TimeUs now_us);
  void take_picture(TimeUs now_us);
  void move_player(const WindowInput& input, double seconds);
  /// Moves the view by `steps` in time. The step after the newest edit is the live world.
  void scrub(int steps);
  void follow_player(TimeUs now_us);
  MemoryUse memory_use() const;
  /// Keeps the memory within the budget: shrinks the view, or lets it grow again, and bounds the
  /// meshes.
  void limit_memory(TimeUs now_us);
  /// Sends what is queued, and meshes what changed.
  void flush();
  /// Logs who came and left, once a second.
  void log_players(TimeUs now_us);
  void drain_changes();
  void draw(TimeUs now_us);
  std::vector<Marker> markers() const;
  /// Adds the outlines of protected boxes if they are shown.
  void add_ground(std::vector<Marker>& markers) const;
  double draw_distance() const;  // voxels
  void update_title(TimeUs now_us);
  /// Shows a short text to the player for some seconds.
  void tell(std::string text, TimeUs now_us);
  /// Returns the exit code if the program is to end now.
  std::optional<int> exit_code(TimeUs now_us);
  void rest(TimeUs now_us);
  /// Sends a goodbye, writes the files of the options and prints the table. Returns `code`, or
  /// kExitFailed if `code` is kExitOk and a file cannot be written.
  int finish(int code);
  ClientReport report() const;
  bool drift_found() const { return session_.replica().counters().drifted != 0; }

  const ClientOptions options_;
  WakeUp wake_;
  ThreadedSession network_;
  ClientSession& session_;          // of network_
  std::unique_ptr<Window> window_;  // null off screen
  MeshPipeline pipeline_;
  Player player_;
  BodyMaterials body_materials_;  // of the world
  EditTool tool_;
  HeldButton remove_button_, place_button_;
  MemoryBudget budget_;
  ViewFollower view_;
  TerminalChat chat_;
  ScriptActions actions_;
  std::optional<ScriptRunner> runner_;

  TimeUs started_us_ = 0;
  TimeUs polled_us_ = 0;              // when the window was last polled
  TimeUs titled_us_ = 0;              // when the title was last made
  std::string title_;                 // of the window
  TimeUs counted_us_ = 0;             // when frames were last counted
  std::uint64_t counted_frames_ = 0;  // frames presented by then
  double frame_rate_ = 0;             // frames a second, before that
  std::string notice_;                // shown to the player
  TimeUs notice_until_us_ = 0;
  std::string logged_refusal_;  // of the newest request to see the past
  PlayerLog player_log_;
  TimeUs players_logged_us_ = 0;   // when the player log was last updated
  bool logged_read_only_ = false;  // the state of the server that was logged last
  bool shows_ground_ = false;
  bool end_requested_ = false;  // by the user or a signal
};

}  // namespace runstone
