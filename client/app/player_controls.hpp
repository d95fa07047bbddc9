// PlayerControls: carries out what the player does with mouse and keys: moving, editing, choosing,
// looking at the past, taking pictures. InputRouter has routed the input, so it has no events of
// the interface. Thread: the main thread.
#pragma once
#include <cstdint>
#include <utility>

#include "client/app/client_hud.hpp"
#include "client/app/script_actions.hpp"
#include "client/app/terminal_chat.hpp"
#include "client/display/mesh_pipeline.hpp"
#include "client/input/window_input.hpp"
#include "client/play/click_edits.hpp"
#include "client/play/edit_tool.hpp"
#include "client/play/player.hpp"
#include "client/play/player_motion.hpp"
#include "client/session/client_session.hpp"
#include "client/settings/client_settings.hpp"

namespace runstone {

/// Who moves the player.
enum class Driver : std::uint8_t { person, script, benchmark };

class PlayerControls {
 public:
  /// All objects must outlive the controls.
  PlayerControls(ClientSession& session, Player& player, EditTool& tool, MeshPipeline& pipeline,
                 ClientHud& hud, TerminalChat& chat, ScriptActions& actions, Driver driver);

  /// Takes the materials of the world: they decide where a walking player is stopped.
  void set_materials(const MaterialTable& materials);
  /// Carries out the input of the last `seconds`.
  void take(const WindowInput& input, double seconds, const ClientSettings& settings,
            TimeUs now_us);

  /// Returns true if the player pressed the key that leaves the game for its menu since the last
  /// call.
  bool take_release() { return std::exchange(is_released_, false); }
  /// Returns true while the key for the list of players is held.
  bool shows_players() const { return shows_players_; }
  /// Returns true if the outlines of protected ground are shown.
  bool shows_ground() const { return shows_ground_; }
  void show_ground(bool is_shown) { shows_ground_ = is_shown; }

 private:
  void move(const WindowInput& input, double seconds, const ClientSettings& settings);
  void edit(const WindowInput& input, TimeUs now_us);
  /// Carries out an action of a key.
  void act(Action action, TimeUs now_us);
  void take_picture();

  ClientSession& session_;
  Player& player_;
  EditTool& tool_;
  MeshPipeline& pipeline_;
  ClientHud& hud_;
  TerminalChat& chat_;
  ScriptActions& actions_;
  const Driver driver_;
  PlayerMotion motion_;
  ClickEdits clicks_;
  bool shows_players_ = false, shows_ground_ = false, is_released_ = false;
};

}  // namespace runstone
