// The outline that is drawn for a protected box.
#pragma once
#include <optional>

#include "client/render/renderer.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the edges of the box, green if it admits the player, and otherwise red and crossed. Parts of the box
/// that lie farther than `far` from the eye along an axis are left out, because a box may reach
/// through the whole world: the edges that are drawn there instead are farther than the view.
/// Returns nullopt if nothing of the box is within `far`.
std::optional<Marker> ground_marker(const GroundBox& box, const WorldPos& eye, double far);

}  // namespace runstone
