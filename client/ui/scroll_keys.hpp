// Scroll keys: scrolls the window that is being made with ImGui. Only sources of client/ui include
// this file.
#pragma once
#include <imgui.h>

#include <algorithm>

namespace runstone {

/// Returns 1 if the first key is pressed, -1 if the second one is, and otherwise 0.
inline int pressed_step(ImGuiKey forward, ImGuiKey back) {
  const auto is_pressed = [](ImGuiKey key) { return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key)); };
  return (is_pressed(forward) ? 1 : 0) - (is_pressed(back) ? 1 : 0);
}

/// Scrolls by so many pixels down; a negative number scrolls up.
inline void scroll_by(float pixels) {
  if (pixels == 0) return;
  ImGui::SetScrollY(std::clamp(ImGui::GetScrollY() + pixels, 0.0F, ImGui::GetScrollMaxY()));
}
/// Scrolls by so many pages down. A page repeats some lines of the page before.
inline void scroll_by_pages(int pages) {
  scroll_by(static_cast<float>(pages) * ImGui::GetWindowHeight() * 0.8F);
}
/// Scrolls by so many lines of text down.
inline void scroll_by_lines(int lines) {
  scroll_by(static_cast<float>(lines) * ImGui::GetTextLineHeightWithSpacing());
}

}  // namespace runstone
