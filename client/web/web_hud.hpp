// WebHud: the heads-up display of the browser client: the hotbar, notices, chat and players. The page
// shows them beside the canvas; this object sends it what changed. Thread: the page's only one.
#pragma once
#include <string>
#include <string_view>

#include "client/play/hotbar.hpp"
#include "client/play/player.hpp"
#include "client/replica/replica_changes.hpp"
#include "client/session/client_session.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

class WebHud {
 public:
  /// Both must outlive the object.
  WebHud(ClientSession& session, Player& player) : session_(session), player_(player) {}

  /// Takes the materials of a world. `fills`: the hotbar begins anew.
  void set_materials(const MaterialTable& materials, bool fills);
  void choose(std::size_t slot);
  void scroll(int steps);
  void hold(Material material);

  void notify(std::string_view text, bool is_warning);
  /// Shows what the server sent about edits and its disk.
  void take(const ReplicaChanges& changes);
  /// Sends a line: a command if it begins with "/", otherwise chat.
  void say(const std::string& line);
  /// Shows what has changed of chat, answers and players. Call it every turn.
  void step();
  /// Shows a line about the state while playing.
  void set_state(const std::string& text);

 private:
  void show_slots();

  ClientSession& session_;
  Player& player_;
  Hotbar hotbar_;
  std::string players_ = "?", state_;  // that the page shows
  bool told_read_only_ = false;        // the state of the server that was shown last
  bool is_answer_due_ = false;         // a command was sent, and its output is not shown
};

}  // namespace runstone
