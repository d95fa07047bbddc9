// Time travel: a session looks at its view as it was at an earlier sequence, read-only; the live world goes on and nobody
// else notices. Its chunks then come from workers (base, keyframe and log), no commit concerns them, and a chunk whose
// version it has already is not sent again: to scrub costs what changed. A `moment` message stands before the first
// chunk of each moment, in the class of chunks, so the order tells which moment a chunk belongs to.
#pragma once
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// The newest wish of a session replaces those before it. Back to the live world at once; to the past when a worker has
/// opened the moment, of which kMomentsOpeningMax are under way at a time.
void on_history_request(WorldState& world, SessionId session, const HistoryRequest& travel,
                        const Clocks& now);
/// A new tick: wishes that had to wait.
void open_waiting_moments(WorldState& world);
/// The port's answer: where the moment lies, or why there is none.
void on_moment_opened(WorldState& world, SessionId session, std::uint32_t request,
                      const Result<OpenedMoment, std::string>& opened, const Clocks& now);
/// The port's answer; null if the chunk cannot be read.
void on_past_chunk(WorldState& world, SessionId session, std::uint32_t visit, const ChunkKey& key,
                   const ChunkPtr& chunk, const Clocks& now);

/// Asks for the session's nearest wanted chunks as they were. Requires a visit.
void deliver_past(WorldState& world, SessionId session, const Clocks& now);
/// The session's view has changed: what it may have forgotten is not known.
void forget_sent(WorldSession& session);

inline constexpr std::size_t kMomentsOpeningMax =
    2;  // all sessions together: each reads a stretch of the log
inline constexpr std::size_t kPastChunksLoadingMax = 8;  // per session

}  // namespace runstone
