#include "client/ui/palette_window.hpp"

#include <imgui_stdlib.h>

#include <algorithm>
#include <string_view>

#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return out;
}

bool has_all_words(const std::string& name, std::string_view words) {
  while (!words.empty()) {
    const std::size_t length = std::min(words.find(' '), words.size());
    if (name.find(words.substr(0, length)) == std::string::npos) return false;
    words.remove_prefix(std::min(length + 1, words.size()));
  }
  return true;
}

}  // namespace

std::vector<Material> matching_materials(const MaterialTable& table, const std::string& text) {
  const std::string wanted = lower_case(text);
  std::vector<Material> first, rest;
  for (std::size_t id = 1; id < table.size(); ++id) {
    const auto material = static_cast<Material>(id);
    if (table[material].visibility == Visibility::empty) continue;
    const std::string shown = lower_case(short_name(table[material].name));
    if (!has_all_words(shown + " " + lower_case(table[material].name), wanted)) continue;
    (shown.starts_with(wanted) ? first : rest).push_back(material);
  }
  first.insert(first.end(), rest.begin(), rest.end());
  return first;
}

void PaletteWindow::open() {
  is_open_ = takes_focus_ = true;
  search_.clear();
}

void PaletteWindow::update_matches(const MaterialTable& table) {
  if (matched_ == search_ && matched_count_ == table.size()) return;
  matched_ = search_;
  matched_count_ = table.size();
  matches_ = matching_materials(table, search_);
}

std::optional<Material> PaletteWindow::build(const MaterialTable& table, Material held,
                                             double scale) {
  if (!is_open_) return std::nullopt;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y * 0.45F}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({size.x * 0.6F, size.y * 0.66F}, ImGuiCond_Appearing);
  ImGui::Begin(
      "Materials", &is_open_,
      ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  if (takes_focus_) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool is_entered = ImGui::InputTextWithHint("##search", "search", &search_,
                                                   ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive()) takes_focus_ = false;
  update_matches(table);
  std::optional<Material> chosen = build_grid(table, held, scale);
  if (is_entered && !matches_.empty()) chosen = matches_.front();
  ImGui::End();
  if (chosen) close();
  return chosen;
}

std::optional<Material> PaletteWindow::build_grid(const MaterialTable& table, Material held,
                                                  double scale) {
  std::optional<Material> chosen;
  ImGui::BeginChild("grid");
  if (matches_.empty()) ImGui::TextDisabled("no material has this name");
  const ImVec2 spacing = ImGui::GetStyle().ItemSpacing;
  const float wide = ImGui::GetContentRegionAvail().x;
  const int columns = std::max(1, static_cast<int>(wide / static_cast<float>(170 * scale)));
  const auto cells = static_cast<float>(columns);
  const ImVec2 cell{(wide - spacing.x * (cells - 1)) / cells, static_cast<float>(32 * scale)};
  const int count = static_cast<int>(matches_.size());
  ImGuiListClipper clipper;
  clipper.Begin((count + columns - 1) / columns, cell.y + spacing.y);
  while (clipper.Step()) {
    for (int i = clipper.DisplayStart * columns; i < std::min(count, clipper.DisplayEnd * columns);
         ++i) {
      const Material material = matches_[static_cast<std::size_t>(i)];
      const MaterialInfo& info = table[material];
      if (i % columns != 0) ImGui::SameLine();
      ImGui::PushID(i);
      const ImVec2 from = ImGui::GetCursorScreenPos();
      if (ImGui::Selectable("##cell", material == held, 0, cell)) chosen = material;
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s  %d", info.name.c_str(), int{material});
      ImDrawList& list = *ImGui::GetWindowDrawList();
      const auto inset = static_cast<float>(3 * scale);
      const float side = cell.y - 2 * inset;
      swatch(list, {from.x + inset, from.y + inset}, {from.x + inset + side, from.y + inset + side},
             info.colour);
      const std::string name = short_name(info.name);
      const float text_top = from.y + (cell.y - ImGui::GetTextLineHeight()) / 2;
      list.PushClipRect(from, {from.x + cell.x, from.y + cell.y}, true);
      list.AddText({from.x + side + 4 * inset, text_top}, ImGui::GetColorU32(ImGuiCol_Text),
                   name.data(), name.data() + name.size());
      list.PopClipRect();
      ImGui::PopID();
    }
  }
  ImGui::EndChild();
  return chosen;
}

}  // namespace runstone
