// PreviewExchange: shares what this player's next click does with the other players, and makes the
// ghosts of what they share. One thread.
#pragma once
#include <vector>

#include "client/app/others_previews.hpp"
#include "client/play/edit_tool.hpp"
#include "client/session/client_session.hpp"
#include "client/settings/client_settings.hpp"

namespace runstone {

class PreviewExchange {
 public:
  /// Both must outlive this object.
  PreviewExchange(ClientSession& session, const EditTool& tool) : session_(session), tool_(tool) {}

  void set_materials(const MaterialTable& materials) { others_.set_materials(materials); }
  /// Shares this player's preview and makes the ghosts of the others, if the settings allow it and
  /// the tool box shows previews. Returns true if the ghosts changed. Call it every turn. Cost:
  /// that of OthersPreviews::step().
  bool step(const ClientSettings& settings, TimeUs now_us);
  void append_ghosts(std::vector<GhostChunk>& out) const { others_.append_ghosts(out); }

 private:
  ClientSession& session_;
  const EditTool& tool_;
  OthersPreviews others_;
};

}  // namespace runstone
