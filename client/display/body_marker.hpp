// The box that stands for another player.
#pragma once
#include <optional>

#include "client/render/renderer.hpp"
#include "common/core/ids.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// A player's body, in a colour of their own, so that two builders are told apart. None if `eye` is in it, or
/// so near that the picture would begin inside: two players in one place (at the spawn, say) both want to see
/// the world.
std::optional<Marker> body_marker(AuthorId author, const WorldPos& at, const WorldPos& eye);

}  // namespace runstone
