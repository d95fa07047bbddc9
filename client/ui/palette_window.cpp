#include "client/ui/palette_window.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "client/ui/block_icon.hpp"
#include "client/ui/text_field.hpp"
#include "client/ui/ui_draw.hpp"
#include "common/materials/readable_name.hpp"

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
  // Names that begin with the text, names of which a later word does, and the others.
  std::array<std::vector<Material>, 3> ranks;
  for (std::size_t id = 1; id < table.size(); ++id) {
    const auto material = static_cast<Material>(id);
    if (table[material].visibility == Visibility::empty) continue;
    const std::string shown = lower_case(readable_name(table[material].name));
    if (!has_all_words(shown + " " + lower_case(table[material].name), wanted)) continue;
    const std::size_t rank = shown.starts_with(wanted)                               ? 0
                             : (" " + shown).find(" " + wanted) != std::string::npos ? 1
                                                                                     : 2;
    ranks[rank].push_back(material);
  }
  std::vector<Material> out = std::move(ranks[0]);
  for (const std::size_t rank : {1U, 2U})
    out.insert(out.end(), ranks[rank].begin(), ranks[rank].end());
  return out;
}

void PaletteWindow::open() {
  is_open_ = takes_focus_ = true;
  search_.clear();
}

void PaletteWindow::update_matches(const MaterialTable& table) {
  Matched wanted{search_, table.size(), order_};
  if (matched_ == wanted) return;
  matches_ = matching_materials(table, search_);
  sort_materials(matches_, table, order_);
  matched_ = std::move(wanted);
}

void PaletteWindow::build_orders() {
  constexpr std::array<std::pair<MaterialOrder, const char*>, 3> kOrders = {
      {{MaterialOrder::table, "as in the world"},
       {MaterialOrder::name, "by name"},
       {MaterialOrder::colour, "by colour"}}};
  for (const auto& [order, label] : kOrders) {
    if (order != kOrders.front().first) ImGui::SameLine();
    if (ImGui::RadioButton(label, order_ == order)) order_ = order;
  }
}

std::optional<Material> PaletteWindow::build_recent(const HudState& state, double scale) {
  std::optional<Material> chosen;
  const auto side = static_cast<float>(26 * scale);
  bool is_first = true;
  for (const Material material : state.recent) {
    if (!state.materials->knows(material)) continue;
    if (!is_first) {
      ImGui::SameLine();
      if (ImGui::GetContentRegionAvail().x < side) {
        ImGui::NewLine();
        break;
      }
    }
    is_first = false;
    const MaterialInfo& info = (*state.materials)[material];
    ImGui::PushID(int{material});
    const ImVec2 from = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##recent", false, 0, {side, side})) chosen = material;
    if (ImGui::IsItemHovered())
      ImGui::SetTooltip("used lately: %s", readable_name(info.name).c_str());
    block_icon(*ImGui::GetWindowDrawList(), {from.x + 2, from.y + 2},
               {from.x + side - 2, from.y + side - 2}, info);
    ImGui::PopID();
  }
  return chosen;
}

std::optional<HotbarOrder> PaletteWindow::build_hotbars(const std::vector<std::string>& names) {
  using What = HotbarOrder::What;
  std::optional<HotbarOrder> out;
  const float wide = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(wide * 0.3F);
  text_field("##hotbar", "name of a hotbar", hotbar_);
  ImGui::SameLine();
  if (enabled_button("Keep hotbar", !hotbar_.empty())) out = HotbarOrder{What::keep, hotbar_};
  ImGui::SameLine();
  const bool is_kept = std::find(names.begin(), names.end(), hotbar_) != names.end();
  if (enabled_button("Forget", is_kept)) out = HotbarOrder{What::forget, hotbar_};
  if (names.empty()) return out;
  ImGui::SameLine();
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##hotbars", "Take a hotbar")) {
    for (const std::string& name : names) {
      if (!ImGui::Selectable(name.c_str())) continue;
      hotbar_ = name;
      out = HotbarOrder{What::take, name};
    }
    ImGui::EndCombo();
  }
  return out;
}

void PaletteWindow::build(const HudState& state, double scale, std::vector<UiAction>& out) {
  if (!is_open_) return;
  const MaterialTable& table = *state.materials;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({size.x / 2, size.y * 0.45F}, ImGuiCond_Appearing, {0.5F, 0.5F});
  ImGui::SetNextWindowSize({size.x * 0.6F, size.y * 0.66F}, ImGuiCond_Appearing);
  ImGui::Begin("Materials", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
  if (takes_focus_) ImGui::SetKeyboardFocusHere();
  ImGui::SetNextItemWidth(-1);
  const bool is_entered = ImGui::InputTextWithHint("##search", "search", &search_,
                                                   ImGuiInputTextFlags_EnterReturnsTrue);
  if (ImGui::IsItemActive()) takes_focus_ = false;
  build_orders();
  std::optional<Material> chosen = build_recent(state, scale);
  update_matches(table);
  if (const auto in_grid = build_grid(table, state.slots[state.slot], scale)) chosen = in_grid;
  if (is_entered && !matches_.empty()) chosen = matches_.front();
  const auto order = build_hotbars(state.hotbars);
  ImGui::End();
  if (chosen) out.emplace_back(HoldMaterial{*chosen});
  if (order) out.emplace_back(*order);
  if (chosen || (order && order->what == HotbarOrder::What::take)) close();
}

std::optional<Material> PaletteWindow::build_grid(const MaterialTable& table, Material held,
                                                  double scale) {
  std::optional<Material> chosen;
  ImGui::BeginChild("grid", {0, -ImGui::GetFrameHeightWithSpacing()});  // the hotbars are below
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
      block_icon(list, {from.x + inset, from.y + inset},
                 {from.x + inset + side, from.y + inset + side}, info);
      const std::string name = readable_name(info.name);
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
