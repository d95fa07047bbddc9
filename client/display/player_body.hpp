// The body that is drawn for another player.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "client/render/body.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the colour by which a player is known, r, g, b. It depends on the author only.
std::array<std::uint8_t, 3> player_colour(AuthorId author);

/// Returns the body of a player with this pose, in player_colour(). Returns nullopt if `eye` is
/// inside the body, or so near that the near plane would cut it, because the body would hide the
/// world. This happens to players who stand at the spawn together.
std::optional<Body> player_body(AuthorId author, const Pose& pose, const WorldPos& eye);

}  // namespace runstone
