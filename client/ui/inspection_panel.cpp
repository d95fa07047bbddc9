#include "client/ui/inspection_panel.hpp"

#include <fmt/format.h>

#include <array>
#include <string>

#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

struct ModeText {
  InspectionMode mode;
  Action action;
  const char* what;
};
constexpr std::array<ModeText, kInspectionModeCount> kTexts = {
    {{InspectionMode::wireframe, Action::inspect_wireframe, "edges of quads"},
     {InspectionMode::runs, Action::inspect_runs, "ends of stored runs"},
     {InspectionMode::orders, Action::inspect_orders, "axis orders of chunks"},
     {InspectionMode::layers, Action::inspect_layers, "layers meshed again"}}};

constexpr std::array<const char*, kAxisOrderCount> kOrderNames = {"xyz", "xzy", "yxz",
                                                                  "yzx", "zxy", "zyx"};

void legend_row(ImU32 colour, const char* text) {
  const float side = ImGui::GetTextLineHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side}, colour);
  ImGui::Dummy({side, side});
  ImGui::SameLine();
  ImGui::TextUnformatted(text);
}

}  // namespace

void build_inspection_boxes(const KeyMap& keys, InspectionModes& modes) {
  for (std::size_t i = 0; i < kTexts.size(); ++i) {
    const ModeText& row = kTexts[i];
    bool is_on = modes[row.mode];
    const std::string label = fmt::format("{} ({})", row.what, keys.keys_text(row.action));
    if (i % 2 == 1) ImGui::SameLine(ImGui::GetFontSize() * 16);
    if (ImGui::Checkbox(label.c_str(), &is_on)) modes.set(row.mode, is_on);
  }
}

void build_inspection_legend(const InspectionModes& modes, double scale) {
  const bool has_rows =
      modes[InspectionMode::runs] || modes[InspectionMode::orders] || modes[InspectionMode::layers];
  if (!has_rows) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto gap = static_cast<float>(12 * scale);
  ImGui::SetNextWindowPos({gap, size.y - gap}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowBgAlpha(0.7F);
  // The size is set, because a window that measures itself has it one frame late.
  const int rows = (modes[InspectionMode::runs] ? 1 : 0) + (modes[InspectionMode::layers] ? 1 : 0) +
                   (modes[InspectionMode::orders] ? 1 + kAxisOrderCount : 0);
  const ImVec2 padding = ImGui::GetStyle().WindowPadding;
  const float line = ImGui::GetTextLineHeightWithSpacing();
  ImGui::SetNextWindowSize(
      {ImGui::GetFontSize() * 22 + 2 * padding.x, static_cast<float>(rows) * line + 2 * padding.y});
  ImGui::Begin("##inspection", nullptr, kShowOnly & ~ImGuiWindowFlags_AlwaysAutoResize);
  if (modes[InspectionMode::runs])
    legend_row(IM_COL32(20, 200, 245, 255), "a stored run ends here, within 3 chunks");
  if (modes[InspectionMode::layers])
    legend_row(IM_COL32(255, 209, 38, 255), "meshed again just now");
  if (modes[InspectionMode::orders]) {
    ImGui::TextUnformatted("axis order, fastest first");
    for (const AxisOrder order : kAxisOrders) {
      const InspectionColour c = colour_of(order);
      legend_row(IM_COL32(c[0], c[1], c[2], 255), kOrderNames[static_cast<std::size_t>(order)]);
    }
  }
  ImGui::End();
}

}  // namespace runstone
