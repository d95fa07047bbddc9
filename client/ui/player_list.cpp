#include "client/ui/player_list.hpp"

#include "client/ui/ui_draw.hpp"

namespace runstone {

void build_player_list(const HudState& state, double scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y * 0.12F}, ImGuiCond_Always, {0.5F, 0});
  ImGui::SetNextWindowSizeConstraints({static_cast<float>(320 * scale), 0},
                                      {size.x * 0.9F, size.y * 0.8F});
  ImGui::Begin("players", nullptr, kShowOnly);
  ImGui::Text("%zu %s here", state.players.size(),
              state.players.size() == 1 ? "player is" : "players are");
  ImGui::Separator();
  if (ImGui::BeginTable("list", 4, ImGuiTableFlags_SizingFixedFit)) {
    for (const ListedPlayer& player : state.players) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(player.name.c_str());
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", player.fingerprint.c_str());
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(player.role.c_str());
      ImGui::TableNextColumn();
      ImGui::TextDisabled("%s", player.distance.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace runstone
