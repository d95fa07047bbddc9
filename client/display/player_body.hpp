// The body that is drawn for another player.
#pragma once
#include <optional>

#include "client/render/body.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the body of a player with this pose, in author_rgb(). Returns nullopt if `eye` is
/// inside the body, or so near that the near plane would cut it, because the body would hide the
/// world. This happens to players who stand at the spawn together.
std::optional<Body> player_body(AuthorId author, const Pose& pose, const WorldPos& eye);

}  // namespace runstone
