#include "client/ui/ui_draw.hpp"

#include <algorithm>

namespace runstone {
namespace {

constexpr double kGroundShade = 205;  // behind transparent materials

ImU32 with_alpha(ImU32 colour, double alpha) {
  const auto old_alpha = static_cast<double>(colour >> IM_COL32_A_SHIFT & 0xFF);
  const auto new_alpha = static_cast<ImU32>(std::clamp(old_alpha * alpha, 0.0, 255.0));
  return (colour & ~IM_COL32_A_MASK) | new_alpha << IM_COL32_A_SHIFT;
}

}  // namespace

void shadowed_text(ImDrawList& list, ImVec2 at, ImU32 colour, std::string_view text, double alpha,
                   float wrap) {
  const char* const begin = text.data();
  const char* const end = begin + text.size();
  const auto draw = [&](ImVec2 from, ImU32 with) {
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), from, with_alpha(with, alpha), begin, end,
                 wrap);
  };
  draw({at.x + 1, at.y + 1}, IM_COL32(0, 0, 0, 200));
  draw(at, colour);
}

float width_of(std::string_view text) {
  return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

ImVec2 wrapped_size(std::string_view text, float wrap) {
  return ImGui::CalcTextSize(text.data(), text.data() + text.size(), false, wrap);
}

ImU32 shaded_colour(const MaterialColour& colour, double factor) {
  const double alpha = colour[3] / 255.0;
  const auto channel = [&](std::size_t i) {
    const double shade = colour[i] * alpha + kGroundShade * (1 - alpha);
    return static_cast<int>(std::clamp(shade * factor, 0.0, 255.0));
  };
  return IM_COL32(channel(0), channel(1), channel(2), 255);
}

bool enabled_button(const char* label, bool is_enabled) {
  ImGui::BeginDisabled(!is_enabled);
  const bool is_pressed = ImGui::Button(label);
  ImGui::EndDisabled();
  return is_pressed;
}

}  // namespace runstone
