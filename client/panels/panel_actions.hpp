// carry_out_panel: carries out what the user did in a window of PanelWindows.
#pragma once
#include <string>

#include "client/panels/world_panels.hpp"
#include "client/play/edit_tool.hpp"
#include "client/session/client_session.hpp"
#include "client/ui/ui_action.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// Does nothing for an action of another window. Fails with words for the player; why a rollback
/// cannot be ordered stands in its window.
Result<void, std::string> carry_out_panel(const UiAction& action, ClientSession& session,
                                          WorldPanels& panels, EditTool& tool, TimeUs now_us);

}  // namespace runstone
