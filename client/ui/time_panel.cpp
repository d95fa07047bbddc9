#include "client/ui/time_panel.hpp"

#include <cmath>

#include "client/ui/ui_draw.hpp"
#include "common/core/world_time.hpp"

namespace runstone {

std::optional<SetTime> build_time_slider(const HudState& state) {
  constexpr int kMinutes = 1440;
  std::optional<SetTime> out;
  const double share = state.time_of_day - std::floor(state.time_of_day);
  int minute = static_cast<int>(std::lround(share * kMinutes)) % kMinutes;
  // The slider shows the time instead of the number of minutes.
  const std::string text = day_time_text(static_cast<std::uint32_t>(minute) * 60'000);
  if (ImGui::SliderInt("for you alone", &minute, 0, kMinutes - 1, text.c_str(),
                       ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput))
    out = SetTime{minute / double{kMinutes}};
  ImGui::BeginDisabled(!state.has_own_time);
  if (ImGui::Button("The world's time")) out = SetTime{};
  ImGui::EndDisabled();
  return out;
}

}  // namespace runstone
