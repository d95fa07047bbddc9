// Text field: ImGui's text input for a std::string. Only sources of client/ui include this file.
#pragma once
#include <imgui.h>

#include <string>

namespace runstone {

/// Makes a text field. `hint` is shown while the text is empty. Returns what ImGui::InputText()
/// returns. A text has at most 255 bytes.
bool text_field(const char* label, const char* hint, std::string& text,
                ImGuiInputTextFlags flags = 0);

}  // namespace runstone
