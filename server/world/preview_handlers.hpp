// Preview handlers: pass on what a player is about to do to those who see the place. A preview is in
// no log and changes nothing. It is dropped, not queued, where it does not fit: the sender's next one
// replaces it.
#pragma once
#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// The sessions that get one preview, at most.
inline constexpr std::size_t kPreviewReadersMax = 32;

/// Sends the preview to the sessions that see, together with the sender, a chunk that it touches:
/// sessions with the feature that are in the live world, whose queue is not full, of other players.
/// Sessions that got the sender's last preview and do not get this one are told that it is gone. A
/// preview that the server would refuse as an edit, because of reach, heights, size or materials, is
/// passed on as none; rights are not checked. What is passed on counts as read from the sender.
/// Cost: O(touched chunks + their subscribers).
void on_preview_share(WorldState& world, SessionId session, const PreviewShare& share,
                      const Clocks& now);

}  // namespace runstone
