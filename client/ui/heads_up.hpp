// The part of the display that is always there: the crosshair, the hotbar, the place, hints and the
// names over heads.
#pragma once
#include "client/ui/hud_state.hpp"

namespace runstone {

/// Makes this part with ImGui. `name_seconds` is the time since another slot was chosen: the name
/// of its material is shown for some seconds. Returns the y of the highest pixel row of the hotbar.
double build_heads_up(const HudState& state, double name_seconds, double scale);

/// The time for which the name of the held material is shown, in seconds.
inline constexpr double kSlotNameSeconds = 2.5;
/// The time for which it fades at the end of that time, in seconds.
inline constexpr double kSlotNameFadeSeconds = 0.5;

}  // namespace runstone
