// Client: the main thread of runstone-client. It owns the session, the window, the picture and the script,
// and passes between them what the network thread, the mesh workers and the draw thread hand over. Nothing
// here waits for a peer or for a frame: a turn takes what is there, and the next one comes when there is more
// (WakeUp), a frame or the next look at the window's input is due, or the script wants to go on.
#pragma once
#include <csignal>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/app/options.hpp"
#include "client/app/player.hpp"
#include "client/cache/cache_thread.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/net/net_client.hpp"
#include "client/net/wake_up.hpp"
#include "client/platform/window.hpp"
#include "client/replica/client_session.hpp"
#include "client/replica/copy_box.hpp"
#include "client/report/report.hpp"
#include "client/schedule/view_pace.hpp"
#include "client/script/script_host.hpp"
#include "client/script/script_runner.hpp"
#include "common/os/exit_code.hpp"

namespace runstone {

class Client final : private ScriptHost {
 public:
  /// `script` may be null and must outlive the client. Throws std::runtime_error if the environment is broken
  /// (no OpenGL, key file unreadable).
  Client(ClientOptions options, const Script* script);
  ~Client() override;

  /// Returns the exit code once the script, the user, the server, `stop` (set by a signal) or a driver that
  /// fails ends it. In each of these cases the goodbye is said and what was asked for is written.
  int run(const volatile std::sig_atomic_t& stop);

 private:
  /// Turn after turn. Throws std::runtime_error if drawing fails.
  int play(const volatile std::sig_atomic_t& stop);
  // The turn, in its order.
  void take_events();
  void on_connected(const NetConnected& event);
  void on_received(NetReceived& event);
  void on_disconnected(const NetDisconnected& event);
  void world_opened();
  void take_input(TimeUs now_us);
  void see_completeness(TimeUs now_us);
  void follow_player(TimeUs now_us);
  /// Sends what is to be sent, and meshes what is to be meshed.
  void settle();
  void flush();
  /// Asks the cache what the session wants of it, and hands over what is to be kept: now and then, or `all` at once.
  void step_cache(TimeUs now_us, bool all);
  void drain_changes();
  void draw(TimeUs now_us);
  void show_title(TimeUs now_us);
  std::optional<int> exit_code(TimeUs now_us);
  void rest(TimeUs now_us);
  /// Says goodbye, writes what was asked for, and returns the exit code: a file that cannot be written fails.
  int finish(int code);

  /// The view is where the player is: what is said about chunks in view holds for what surrounds them.
  bool view_has_followed() const;
  /// Every chunk in view is here.
  bool is_complete() const { return view_has_followed() && session_.loaded(); }
  bool drift_found() const { return session_.replica().counters().drifted != 0; }
  std::vector<Marker> markers() const;
  ClientReport report() const;
  std::string screenshot_path(const std::string& file) const;
  void click(bool place, TimeUs now_us);
  /// A step earlier or later in time; beyond the newest edit lies the live world.
  void scrub(int steps);

  // ScriptHost.
  bool ready() const override { return session_.connect_count() != 0; }
  WorldPos eye() const override { return player_.eye(); }
  void move_to(const WorldPos& eye) override;
  void look(double yaw, double pitch) override;
  std::optional<Material> material(std::string_view name) const override;
  std::optional<Material> shown_at(VoxelPos at) const override {
    return session_.replica().shown_at(at);
  }
  Result<std::shared_ptr<const Clipboard>> copy(const VoxelBox& box, bool solid) const override {
    return copy_box(session_.replica(), box, solid ? CopyEmpty::as_untouched : CopyEmpty::as_empty);
  }
  std::optional<RayHit> pick() const override;
  std::optional<std::int32_t> surface(std::int32_t x, std::int32_t z) const override;
  bool submit(const EditDescriptor& edit, TimeUs due_us, TimeUs now_us) override;
  bool loaded() const override;
  bool durable() const override { return session_.replica().local_edits().all().empty(); }
  std::uint64_t sync_mark() const override { return session_.pongs(); }
  bool synced(std::uint64_t mark) const override;
  void travel(const HistoryRequest& travel) override {
    static_cast<void>(session_.request_history(travel));
  }
  bool travelling() const override { return session_.loading_history(); }
  std::string command(const std::string& text) override;
  bool commanding() const override { return session_.commanding(); }
  bool show_answer() override;
  std::string travel_refusal() const override { return session_.history_refusal(); }
  TimeUs utc_now_us() const override;
  bool screenshot(const std::string& file) override;
  std::optional<bool> screenshot_written() const override;
  bool digests(const std::string& file) override { return write_digests(file, session_); }

  const ClientOptions options_;
  WakeUp wake_;
  std::unique_ptr<CacheThread> cache_;  // null without one
  ClientSession session_;
  std::size_t pins_known_ = 0;
  std::unique_ptr<Window> window_;  // null off screen
  MeshPipeline pipeline_;
  std::optional<ScriptRunner> runner_;
  Player player_;
  ViewPace view_pace_;
  ChunkStats chunk_stats_;

  std::deque<NetEvent> events_;      // taken from the network, not handled yet
  ConnectionNumber connection_ = 0;  // 0: none
  std::uint64_t connects_seen_ = 0;
  TimeUs started_us_ = 0;
  std::optional<TimeUs> lost_us_;      // without a session since
  std::string last_failure_;           // why the last attempt to connect failed
  std::optional<TimeUs> complete_us_;  // everything in view is here since
  Sequence scrubbed_to_ = 0;           // while the past is shown or asked for
  std::optional<int> wish_to_end_;     // the user or the server ends the program

  TimeUs input_us_ = 0, title_us_ = 0, kept_us_ = 0;
  std::uint64_t title_frames_ = 0;  // presented when the title was set

  std::unique_ptr<NetClient> net_;  // last: its thread wakes what is above
};

}  // namespace runstone
