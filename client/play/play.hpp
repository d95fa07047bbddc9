// Play: what a player does in the world of a server, from the click to the contents of a frame. The
// desktop client and the client in a browser share it. The program around it carries the messages
// of the session, shows the interface and draws. A turn of the program calls, in this order:
//   - begin_turn(), after the messages that arrived were handled;
//   - handle_input(), and act() for each action of a key;
//   - take_changes(), after the edits of this turn were sent;
//   - follow(), before the tick of the session;
//   - take_changes() and step_previews(), and step_author() if it shows authors;
//   - frame(), if a frame is due.
// One thread.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client/display/mesh_pipeline.hpp"
#include "client/input/input_router.hpp"
#include "client/input/key_map.hpp"
#include "client/panels/world_panels.hpp"
#include "client/play/chat.hpp"
#include "client/play/click_edits.hpp"
#include "client/play/display_pace.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/frame_scene.hpp"
#include "client/play/hotbar.hpp"
#include "client/play/named_hotbars.hpp"
#include "client/play/others_previews.hpp"
#include "client/play/player.hpp"
#include "client/play/player_motion.hpp"
#include "client/play/recent_materials.hpp"
#include "client/play/server_notices.hpp"
#include "client/play/texture_feed.hpp"
#include "client/play/view_follower.hpp"
#include "client/play/view_limits.hpp"
#include "client/play/world_kit.hpp"
#include "client/report/report.hpp"
#include "client/session/client_session.hpp"
#include "client/tools/tool_box.hpp"
#include "client/ui/hud_state.hpp"
#include "client/ui/ui_action.hpp"

namespace runstone {

/// Who moves the player.
enum class Driver : std::uint8_t { person, script, benchmark };

struct PlayConfig {
  ViewWishes wishes;
  KeyMap keys;
  Driver driver = Driver::person;
  bool walks = false;      // at first; otherwise the player flies
  bool is_watched = true;  // frames go to a window
  unsigned workers = 0;    // threads that mesh
  TimeUs started_us = 0;   // when the client began to connect
  /// The time of day that the player has chosen, as FrameLook::time_of_day. nullopt: the world's.
  std::optional<double> time_of_day;
  /// Returns the kit that the program has kept for a world. Empty: none is kept.
  std::function<std::optional<WorldKit>(const WorldId&)> kit_of;
  HotbarLists hotbars = {};  // that the program has kept
};

/// The kit that the program stores for a world.
struct KeptKit {
  WorldId world{};
  WorldKit kit;
};

/// The settings that the player may change while playing.
struct PlaySettings {
  LookSettings look;
  bool shows_previews = true;   // ghosts of what other players are about to do
  bool shares_previews = true;  // others see what this player is about to do
  bool shows_textures = true;   // the pictures that the world brings for its materials
  bool shows_authors = true;    // who set the voxel at the crosshair
};

/// The contents of a frame, and its size in pixels.
struct FrameChoice {
  std::optional<double> field_of_view;             // as FrameScene::camera()
  bool outlines_aim = true, shows_ground = false;  // as FrameScene::contents()
  std::array<int, 2> size{};
};

/// Gets what a program may write into its log.
class PlayLog {
 public:
  virtual ~PlayLog() = default;
  /// The client did not accept an edit.
  virtual void on_edit_refused(const std::string& /*why*/) {}
  /// The replica changed. `state` has the notices about the state of the server.
  virtual void on_changes(const ReplicaChanges& /*changes*/,
                          std::span<const PlayerNotice> /*state*/) {}
  /// The world got `count` materials since it was opened.
  virtual void on_new_materials(std::size_t /*count*/) {}
  /// The view or the distant ground was changed to keep the memory within its budget.
  virtual void on_view_limited(const LimitChange& /*change*/) {}
};

class Play {
 public:
  /// All but `config` must outlive the object. `draw_queue` may be null, see MeshPipeline. `wake`
  /// is called from mesh threads; it may be null without them.
  Play(ClientSession& session, ToolBox& tools, DrawQueue* draw_queue, PlayLog& log,
       const PlayConfig& config, std::function<void()> wake = nullptr);

  /// Takes up what changed since the last turn, and keeps the memory within its budget.
  /// `is_opened`: a world was opened, for the first time or again. `shown`: the open windows.
  void begin_turn(bool is_opened, const ShownPanels& shown, TimeUs now_us);
  /// Routes the queued input, moves the player, and carries out clicks and the turns of the wheel.
  /// Returns the input: the caller carries out the actions, and gives the interface its events.
  RoutedInput handle_input(const UiFocus& focus, const PlaySettings& settings, TimeUs now_us);
  /// Carries out an action of a key: one of the tools, the hotbar, the player or the past. Returns
  /// false if it is an action of the interface or of the program.
  bool act(Action action, TimeUs now_us);
  /// Carries out what the user did in a window.
  void carry_out(const UiAction& action, TimeUs now_us);
  /// Passes the changes of the replica on. Call it after whatever changes the replica.
  void take_changes(TimeUs now_us);
  /// Moves the view with the player.
  void follow(TimeUs now_us);
  /// Shares the preview of the player's next click, and makes a bounded part of its ghosts and of
  /// the ghosts of the other players.
  void step_previews(const PlaySettings& settings, TimeUs now_us);
  /// Gets the textures of the world and gives them to the screen, if the settings want them and
  /// something is drawn. Call it before the tick of the session.
  void step_textures(const PlaySettings& settings, TimeUs now_us);
  /// Asks now and then who set the voxel at the crosshair, if the settings want it.
  void step_author(const PlaySettings& settings, TimeUs now_us);
  /// Makes a window draw often while something moves, see DisplayPace. `is_fading`: the interface
  /// draws something that moves.
  void keep_pace(bool has_focus, bool is_fading, TimeUs now_us);
  /// Returns a frame to order, without the interface. Requires pipeline().is_frame_due().
  FrameOrder frame(const FrameChoice& choice, TimeUs now_us);

  /// Shows this time of day instead of the world's, or the world's again with nullopt. Others do
  /// not see it.
  void set_own_time(std::optional<double> share);
  /// Returns the kits that have changed since the last call, or since their world was opened: those
  /// of the worlds that were left, and that of the present one.
  std::vector<KeptKit> take_kits();
  /// Returns the hotbars of this player if one was kept or forgotten since the last call.
  std::optional<HotbarLists> take_hotbars();
  /// Keeps, takes or forgets a hotbar. Returns a line for the player, as value or as failure.
  Result<std::string, std::string> carry_out(const HotbarOrder& order);
  /// Returns the notices for the player since the last call.
  std::vector<PlayerNotice> take_notices() { return std::exchange(notices_, {}); }
  /// Returns a line about what is shown: a moment of the past, or why ground is missing. The line
  /// is empty if there is nothing special.
  std::string state_text() const;
  /// Fills what the interface shows of the world, the player and the open windows.
  void fill(HudState& state, const ShownPanels& shown) const;
  /// Returns true if a world was opened.
  bool was_opened() const { return opened_us_.has_value(); }
  /// Returns true if there is ground to see: kGroundChunks are meshed, the view is complete, or the
  /// first world was opened more than `wait_us` ago.
  bool has_ground(TimeUs wait_us, TimeUs now_us) const;
  static constexpr std::uint64_t kGroundChunks = 27;
  /// Sets the measurements of a report besides those of network and horizon.
  void add_to(ClientReport& report, TimeUs now_us) const;
  TimeUs started_us() const { return started_us_; }

  ClientSession& session() { return session_; }
  const ClientSession& session() const { return session_; }
  MeshPipeline& pipeline() { return pipeline_; }
  const MeshPipeline& pipeline() const { return pipeline_; }
  Player& player() { return player_; }
  const Player& player() const { return player_; }
  EditTool& tool() { return tool_; }
  const EditTool& tool() const { return tool_; }
  Hotbar& hotbar() { return hotbar_; }
  const Hotbar& hotbar() const { return hotbar_; }
  InputRouter& input() { return input_; }
  const InputRouter& input() const { return input_; }
  Chat& chat() { return chat_; }
  WorldPanels& panels() { return panels_; }
  const WorldPanels& panels() const { return panels_; }
  const ViewFollower& view() const { return view_; }
  const ViewLimits& limits() const { return limits_; }
  const FrameScene& scene() const { return scene_; }
  const OthersPreviews& others_previews() const { return others_; }
  /// Carries out an order of the rollback window at the place of the player, in the selection if that
  /// is one box. Returns an empty text, or why the order cannot be sent.
  std::string carry_out(const RollbackOrder& order) {
    return panels_.rollback().carry_out(order, player_.eye(), tool_.box().selected_box());
  }

 private:
  void open_world(TimeUs now_us);
  void take_up_kit();
  WorldKit kit() const;
  /// Adds the kit of the present world to changed_kits_ if it has changed.
  void note_kit();
  void show_time(TimeUs now_us);
  void take_new_materials();
  void set_materials(const MaterialTable& materials);
  void limit_memory(TimeUs now_us);
  void move(const WindowInput& input, double seconds, const LookSettings& look);
  /// Puts a material into the player's hand, that of a voxel in sight if it `is_picked`.
  void hold(Material material, bool is_picked, TimeUs now_us);
  void notify(std::string text, NoticeKind kind = NoticeKind::information) {
    notices_.push_back({std::move(text), kind});
  }

  ClientSession& session_;
  PlayLog& log_;
  const Driver driver_;
  const bool walks_;
  const TimeUs started_us_;
  MeshPipeline pipeline_;
  Player player_;
  EditTool tool_;
  PlayerMotion motion_;
  ClickEdits clicks_;
  Hotbar hotbar_;
  NamedHotbars hotbars_;
  RecentMaterials recent_;
  InputRouter input_;
  Chat chat_;
  ViewFollower view_;
  ViewLimits limits_;
  WorldPanels panels_;
  OthersPreviews others_;
  TextureFeed textures_;
  FrameScene scene_;
  DisplayPace pace_;
  ServerNotices server_notices_;
  std::vector<PlayerNotice> notices_;
  std::string author_text_;          // who set the voxel at the crosshair, or empty
  TimeUs author_due_us_ = 0;         // when it is looked up next
  std::optional<WorldId> world_;     // whose materials the hotbar has
  std::uint64_t shapes_number_ = 0;  // ClientSession::shapes_number() of the materials in use
  std::optional<TimeUs> opened_us_;  // when the first world opened
  std::function<std::optional<WorldKit>(const WorldId&)> kit_of_;
  WorldKit kept_kit_;                  // of world_, as the program or changed_kits_ has it
  std::vector<KeptKit> changed_kits_;  // for take_kits()
  std::optional<double> own_time_;     // of day, instead of the world's
  TimeUs input_us_;                    // when input was last handled
};

}  // namespace runstone
