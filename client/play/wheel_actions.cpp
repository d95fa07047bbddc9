#include "client/play/wheel_actions.hpp"

#include <array>
#include <cstdio>

namespace runstone {

std::optional<std::string> act_on_wheel(const WindowInput& input, EditTool& tool, Player& player,
                                        PlayerHotbar& hotbar) {
  if (input.scroll == 0) return std::nullopt;
  if (input.resizes) {
    tool.box().change_size(input.scroll);
    return std::nullopt;
  }
  if (input.fast && !player.is_walking()) {
    player.change_flying_speed(input.scroll);
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "flying speed: %g voxels a second",
                  player.flying_speed());
    return std::string(text.data());
  }
  hotbar.scroll(input.scroll);
  return std::nullopt;
}

}  // namespace runstone
