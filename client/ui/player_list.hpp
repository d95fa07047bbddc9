// The list of players on the screen.
#pragma once
#include "client/ui/hud_state.hpp"

namespace runstone {

/// Makes the list with ImGui: name, fingerprint of the key, role, and distance of each player.
void build_player_list(const HudState& state, double scale);

}  // namespace runstone
