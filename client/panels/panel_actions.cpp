#include "client/panels/panel_actions.hpp"

#include "client/play/time_travel.hpp"

namespace runstone {

Result<void, std::string> carry_out_panel(const UiAction& action, ClientSession& session,
                                          WorldPanels& panels, EditTool& tool, TimeUs now_us) {
  if (const auto* moment = std::get_if<ShowMoment>(&action))
    show_after(session, moment->is_live ? kSequenceShownMax : moment->seq);
  if (const auto* order = std::get_if<RollbackOrder>(&action))
    static_cast<void>(panels.carry_out(*order));
  if (const auto* command = std::get_if<ToolCommand>(&action))
    return tool.carry_out(*command, now_us);
  return {};
}

}  // namespace runstone
