// The box that is drawn for another player.
#pragma once
#include <optional>

#include "client/render/renderer.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Returns the box of a player whose pose is `at`, in a colour that depends on the author. Returns
/// nullopt if `eye` is inside the box, or so near that the near plane would cut it, because the box
/// would hide the world. This happens to players who stand at the spawn together.
std::optional<Marker> body_marker(AuthorId author, const WorldPos& at, const WorldPos& eye);

}  // namespace runstone
