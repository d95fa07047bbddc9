#include "client/ui/help_window.hpp"

#include <optional>
#include <string>

#include "client/ui/ui_draw.hpp"

namespace runstone {

void build_help(const std::vector<KeyRow>& rows, bool& is_open) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y * 0.46F}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {size.x * 0.95F, size.y * 0.82F});
  ImGui::Begin("Keys", &is_open,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
  // The rows go into two columns, cut between two groups.
  const std::size_t middle = rows.size() / 2;
  if (ImGui::BeginTable("columns", 2, ImGuiTableFlags_SizingFixedFit)) {
    ImGui::TableNextColumn();
    std::optional<ActionGroup> group;
    bool is_second = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const KeyRow& row = rows[i];
      if (group != row.group) {
        if (group) ImGui::Spacing();
        if (i >= middle && !is_second) {
          is_second = true;
          ImGui::TableNextColumn();
        }
        ImGui::TextDisabled("%s", std::string(title_of(row.group)).c_str());
      }
      group = row.group;
      ImGui::TextColored({0.75F, 0.88F, 1, 1}, "%s", row.input.c_str());
      ImGui::SameLine(ImGui::GetFontSize() * 11);
      ImGui::TextUnformatted(row.what.c_str());
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace runstone
