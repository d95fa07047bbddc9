#include "client/ui/settings_form.hpp"

#include <imgui.h>

#include <algorithm>
#include <cstddef>

#include "client/render/antialiasing.hpp"
#include "client/ui/text_field.hpp"
#include "common/core/text.hpp"
#include "common/core/tile_keys.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

/// Shows a slider for a double.
void slider(const char* label, double& value, double least, double most, const char* format) {
  ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &least, &most, format,
                      ImGuiSliderFlags_AlwaysClamp);
}

void quality_control(QualityChoice& quality) {
  if (!ImGui::BeginCombo("quality", name_of(quality))) return;
  for (std::size_t i = 0; i < kQualityChoiceCount; ++i) {
    const auto choice = static_cast<QualityChoice>(i);
    if (ImGui::Selectable(name_of(choice), choice == quality)) quality = choice;
  }
  ImGui::EndCombo();
}

void antialiasing_control(Antialiasing& antialiasing) {
  if (!ImGui::BeginCombo("smooth edges", to_string(antialiasing))) return;
  for (const Antialiasing choice : kAntialiasings) {
    if (ImGui::Selectable(to_string(choice), choice == antialiasing)) antialiasing = choice;
  }
  ImGui::EndCombo();
}

}  // namespace

SettingsForm::Result SettingsForm::build(double scale) {
  ClientSettings& s = edited_;
  ImGui::PushItemWidth(static_cast<float>(260 * scale));
  text_field("name", "builder", s.name);
  const bool is_name = s.name.size() <= kPlayerNameBytesMax && is_plain_name(s.name);
  if (!is_name) ImGui::TextDisabled("1 to 32 bytes, without quotes and backslashes");
  text_field("key file", "the kept identity", s.key_file);
  const bool is_file = s.key_file.empty() || s.key_file[0] == '/';
  if (!is_file) ImGui::TextDisabled("a path that begins with /, or empty");
  ImGui::Separator();
  quality_control(s.quality);
  antialiasing_control(s.antialiasing);
  slider("field of view", s.field_of_view, 30, 110, "%.0f degrees");
  int radius = s.view_radius, levels = s.far_levels, memory = static_cast<int>(s.memory_mib);
  if (ImGui::SliderInt("view radius", &radius, 1, int{kViewRadiusMax}, "%d chunks",
                       ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic))
    s.view_radius = static_cast<std::uint8_t>(radius);
  if (ImGui::SliderInt("far ground", &levels, 0, int{kTileLevelMax}, "%d levels",
                       ImGuiSliderFlags_AlwaysClamp))
    s.far_levels = static_cast<std::uint8_t>(levels);
  ImGui::Checkbox("show the textures of worlds", &s.shows_textures);
  bool is_automatic = s.memory_mib == 0;
  if (ImGui::Checkbox("find the memory to use by itself", &is_automatic))
    s.memory_mib = is_automatic ? 0 : 1024;
  if (s.memory_mib != 0 &&
      ImGui::SliderInt("memory", &memory, int{kMemoryMibMin}, int{kMemoryMibMax}, "%d MiB",
                       ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_Logarithmic)) {
    s.memory_mib = static_cast<std::uint64_t>(memory);
  }
  ImGui::Separator();
  slider("mouse speed", s.sensitivity, 0.1, 10, "%.2f");
  ImGui::Checkbox("mouse up looks down", &s.invert_y);
  ImGui::Checkbox("begin on the feet, not flying", &s.walks);
  ImGui::Checkbox("show what others are about to do", &s.shows_previews);
  ImGui::Checkbox("let others see what you are about to do", &s.shares_previews);
  slider("size of text", s.interface_scale, 0.5, 4, "%.2f");
  ImGui::PopItemWidth();
  ImGui::Separator();
  ImGui::TextDisabled("View, memory and size of text change with the next world.");
  ImGui::BeginDisabled(!is_name || !is_file);
  const bool is_kept = ImGui::Button("Keep");
  ImGui::EndDisabled();
  ImGui::SameLine();
  const bool is_dropped =
      ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
  return is_kept ? Result::kept : is_dropped ? Result::dropped : Result::open;
}

}  // namespace runstone
