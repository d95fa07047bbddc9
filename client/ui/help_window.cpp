#include "client/ui/help_window.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>

#include "client/ui/scroll_keys.hpp"
#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

constexpr float kKeysEm = 11.5F, kColumnEm = 38;  // widths, in sizes of the font
constexpr int kLinesOfKey = 3;                    // that an arrow key scrolls

/// Makes the rows [first, last). Long texts are wrapped to the column.
void build_rows(const std::vector<KeyRow>& rows, std::size_t first, std::size_t last) {
  const float keys_width = ImGui::GetFontSize() * kKeysEm;
  std::optional<ActionGroup> group;
  for (std::size_t i = first; i < last; ++i) {
    const KeyRow& row = rows[i];
    if (group != row.group) {
      if (group) ImGui::Spacing();
      ImGui::TextDisabled("%s", std::string(title_of(row.group)).c_str());
    }
    group = row.group;
    const float left = ImGui::GetCursorPosX();
    ImGui::PushTextWrapPos(left + keys_width - ImGui::GetFontSize() / 2);
    ImGui::TextColored({0.75F, 0.88F, 1, 1}, "%s", row.input.c_str());
    ImGui::PopTextWrapPos();
    ImGui::SameLine(keys_width);
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(row.what.c_str());
    ImGui::PopTextWrapPos();
  }
}

}  // namespace

void HelpWindow::build(const std::vector<KeyRow>& rows) {
  if (!is_open_) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(size.x * 0.97F, 2 * kColumnEm * ImGui::GetFontSize());
  ImGui::SetNextWindowPos({size.x / 2, size.y * 0.48F}, ImGuiCond_Always, {0.5F, 0.5F});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, size.y * 0.9F});
  ImGui::Begin("Keys", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
  scroll_by_pages(std::exchange(pages_, 0));
  scroll_by_lines(kLinesOfKey * pressed_step(ImGuiKey_DownArrow, ImGuiKey_UpArrow));
  if (ImGui::BeginTable("columns", 2, ImGuiTableFlags_SizingStretchSame)) {
    const std::size_t middle = (rows.size() + 1) / 2;
    ImGui::TableNextColumn();
    build_rows(rows, 0, middle);
    ImGui::TableNextColumn();
    build_rows(rows, middle, rows.size());
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace runstone
