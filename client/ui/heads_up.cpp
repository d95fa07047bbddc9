#include "client/ui/heads_up.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "client/ui/block_icon.hpp"
#include "client/ui/ui_draw.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {
namespace {

constexpr ImU32 kBright = IM_COL32(240, 244, 248, 255);
constexpr ImU32 kDim = IM_COL32(200, 208, 216, 255);

void centred(ImDrawList& list, float y, ImU32 colour, std::string_view text, double alpha = 1) {
  const float x = (ImGui::GetIO().DisplaySize.x - width_of(text)) / 2;
  shadowed_text(list, {x, y}, colour, text, alpha);
}

void crosshair(ImDrawList& list, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  // Whole pixels keep the lines sharp.
  const float x = static_cast<float>(static_cast<int>(size.x / 2));
  const float y = static_cast<float>(static_cast<int>(size.y / 2));
  const float reach = 8 * scale, half = scale;
  const auto bar = [&](float w, float h, float grow, ImU32 colour) {
    list.AddRectFilled({x - w - grow, y - h - grow}, {x + w + grow, y + h + grow}, colour);
  };
  bar(reach, half, 1, IM_COL32(0, 0, 0, 120));
  bar(half, reach, 1, IM_COL32(0, 0, 0, 120));
  bar(reach, half, 0, IM_COL32(255, 255, 255, 220));
  bar(half, reach, 0, IM_COL32(255, 255, 255, 220));
}

/// Returns the y of the upper edge.
float hotbar(ImDrawList& list, const HudState& state, float scale) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  // A narrow window gets smaller slots.
  const float gap = 4 * scale;
  const float slot = std::min(44 * scale, size.x / kSlotCount - gap);
  const float left = (size.x - kSlotCount * (slot + gap) + gap) / 2;
  const float top = size.y - slot - 12 * scale;
  for (std::size_t i = 0; i < kSlotCount; ++i) {
    const ImVec2 from{left + static_cast<float>(i) * (slot + gap), top};
    const ImVec2 to{from.x + slot, from.y + slot};
    list.AddRectFilled(from, to, IM_COL32(10, 12, 16, 150), 4 * scale);
    const Material material = state.slots[i];
    if (material != kEmpty && state.materials->knows(material)) {
      const float inset = 6 * scale;
      block_icon(list, {from.x + inset, from.y + inset}, {to.x - inset, to.y - inset},
                 (*state.materials)[material]);
    }
    const bool is_chosen = i == state.slot;
    list.AddRect(from, to, is_chosen ? IM_COL32(255, 255, 255, 255) : IM_COL32(255, 255, 255, 60),
                 4 * scale, 0, is_chosen ? 2.5F * scale : 1);
    shadowed_text(list, {from.x + 4 * scale, from.y + 1 * scale}, is_chosen ? kBright : kDim,
                  std::to_string(i + 1));
  }
  return top;
}

void name_plates(ImDrawList& list, const HudState& state, float scale) {
  for (const NamePlate& plate : state.plates) {
    const float width = width_of(plate.name), height = ImGui::GetTextLineHeight();
    const ImVec2 at{static_cast<float>(plate.x) - width / 2,
                    static_cast<float>(plate.y) - height - 2 * scale};
    const auto ground = static_cast<int>(std::clamp(130 * plate.alpha, 0.0, 130.0));
    list.AddRectFilled({at.x - 4 * scale, at.y - 1}, {at.x + width + 4 * scale, at.y + height + 2},
                       IM_COL32(10, 12, 16, ground), 3 * scale);
    shadowed_text(list, at, kBright, plate.name, plate.alpha);
  }
}

/// Draws four bars. The faster the connection is, the more of them are full. If it is slow, the ping
/// stands behind them.
void connection_bars(ImDrawList& list, ImVec2 at, double ping_ms, float scale) {
  constexpr std::array<double, 3> kMsMax = {80, 160, 320};  // of 4, 3 and 2 bars
  const auto slower =
      std::count_if(kMsMax.begin(), kMsMax.end(), [&](double most) { return ping_ms > most; });
  const auto full = static_cast<int>(kMsMax.size()) + 1 - static_cast<int>(slower);
  const float height = ImGui::GetTextLineHeight(), width = 3 * scale, step = 5 * scale;
  for (int i = 0; i < 4; ++i) {
    const float left = at.x + static_cast<float>(i) * step;
    const float top = at.y + height * static_cast<float>(3 - i) * 0.2F;
    const ImVec2 from{left, top}, to{left + width, at.y + height - 2 * scale};
    if (i < full) {
      list.AddRectFilled(from, to, kDim);
    } else {
      list.AddRect(from, to, IM_COL32(200, 208, 216, 120));
    }
  }
  if (full <= 2)
    shadowed_text(list, {at.x + 4 * step + 2 * scale, at.y}, kDim,
                  std::to_string(static_cast<int>(ping_ms)) + " ms");
}

void corner_lines(ImDrawList& list, const HudState& state, float scale) {
  const float x = 10 * scale, line = ImGui::GetTextLineHeightWithSpacing();
  float y = 8 * scale;
  shadowed_text(list, {x, y}, kDim, state.place);
  if (state.ping_ms && state.is_connected)
    connection_bars(list, {x + width_of(state.place) + 12 * scale, y}, *state.ping_ms, scale);
  if (state.aimed_at && state.materials->knows(*state.aimed_at)) {
    y += line;
    shadowed_text(list, {x, y}, kDim,
                  "in sight: " + readable_name((*state.materials)[*state.aimed_at].name));
  }
  if (!state.author.empty()) {
    y += line;
    shadowed_text(list, {x, y}, kDim, "set by " + state.author);
  }
  if (!state.tool.empty()) {
    y += line;
    shadowed_text(list, {x, y}, IM_COL32(170, 220, 255, 255), state.tool);
  }
  if (!state.state.empty()) {
    y += line;
    shadowed_text(list, {x, y}, IM_COL32(255, 210, 120, 255), state.state);
  }
}

}  // namespace

double build_heads_up(const HudState& state, double name_seconds, double scale_value) {
  const auto scale = static_cast<float>(scale_value);
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  name_plates(list, state, scale);
  crosshair(list, scale);
  corner_lines(list, state, scale);
  const float top = hotbar(list, state, scale);
  const Material held = state.slots[state.slot];
  const float line = ImGui::GetTextLineHeightWithSpacing();
  if (name_seconds < kSlotNameSeconds && held != kEmpty && state.materials->knows(held)) {
    const double alpha =
        std::clamp((kSlotNameSeconds - name_seconds) / kSlotNameFadeSeconds, 0.0, 1.0);
    centred(list, top - line - 2 * scale, kBright, readable_name((*state.materials)[held].name),
            alpha);
  }
  if (!state.measure.empty())
    centred(list, ImGui::GetIO().DisplaySize.y / 2 + 14 * scale, IM_COL32(255, 225, 150, 255),
            state.measure);
  if (!state.is_connected) {
    centred(list, ImGui::GetIO().DisplaySize.y * 0.4F, IM_COL32(255, 210, 120, 255),
            "connecting ...");
  } else if (!state.is_captured) {
    centred(list, ImGui::GetIO().DisplaySize.y * 0.56F, kDim,
            "click to capture the mouse   F1 help   escape menu");
  }
  return top - 2 * line;
}

}  // namespace runstone
