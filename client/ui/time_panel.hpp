// The part of the interface for the time of day that this player sees.
#pragma once
#include <optional>

#include "client/ui/hud_state.hpp"

namespace runstone {

/// The user chose a time of day for this client alone, or the time of the world (nullopt).
struct SetTime {
  std::optional<double> share;  // of the day, as FrameLook::time_of_day
};

/// Adds a slider for the time of day, and a button that shows the time of the world again, to the
/// window that is being made with ImGui. Returns what the user did.
std::optional<SetTime> build_time_slider(const HudState& state);

}  // namespace runstone
