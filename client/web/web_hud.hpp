// WebHud: the heads-up display of the browser client: the hotbar, notices, chat and players. The
// page shows them beside the canvas; this object sends it what changed. Thread: the page's only
// one.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "client/play/player_hotbar.hpp"
#include "client/play/server_notices.hpp"
#include "client/play/time_travel.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class WebHud {
 public:
  /// Both must outlive the object.
  WebHud(ClientSession& session, Player& player)
      : session_(session), hotbar_(player), notices_(session) {}

  /// Takes the materials of a world that opens, and fills the hotbar.
  void enter(const MaterialTable& materials);
  /// Adds the materials that the page does not have yet. Cost: O(new materials).
  void add_materials(const MaterialTable& materials);
  PlayerHotbar& hotbar() { return hotbar_; }
  const PlayerHotbar& hotbar() const { return hotbar_; }

  void notify(std::string_view text, bool is_warning);
  /// Shows the notices about rejected edits, the past and the disk of the server.
  void take(const ReplicaChanges& changes);
  /// Sends a line: a command if it begins with "/", otherwise chat.
  void say(const std::string& line);
  /// Shows the changes of the hotbar, chat, answers and players. Call it every turn.
  void step();
  /// Shows a line about the state while playing.
  void set_state(const std::string& text);

 private:
  void show_slots();
  void show_players();
  void show_time();

  ClientSession& session_;
  PlayerHotbar hotbar_;
  ServerNotices notices_;
  std::size_t materials_ = 1;  // that the page shows, and kEmpty
  // That the page shows.
  std::optional<Hotbar> slots_;
  std::string players_ = "?", state_;
  std::optional<ShownSequence> time_;
  bool is_past_ = false;
  bool is_answer_due_ = false;  // a command was sent, and its output is not shown
};

}  // namespace runstone
