#include "client/ui/text_field.hpp"

#include <algorithm>
#include <array>

namespace runstone {

bool text_field(const char* label, const char* hint, std::string& text, ImGuiInputTextFlags flags) {
  std::array<char, 256> buffer{};
  text.copy(buffer.data(), buffer.size() - 1);
  const bool out = ImGui::InputTextWithHint(label, hint, buffer.data(), buffer.size(), flags);
  text = buffer.data();
  return out;
}

}  // namespace runstone
