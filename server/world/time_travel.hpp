// Time travel: a session sees its view as it was after an earlier edit, read-only. Workers make its
// chunks from base, keyframes and log. It gets no commits meanwhile; other sessions are not
// affected. A chunk whose version the session has already is not sent again, so moving in time
// costs what differs. ViewState precedes the first chunk of each state, in the frame class of
// chunks, so the order of messages tells which state a chunk shows.
#pragma once
#include <string>

#include "server/world/world_state.hpp"

namespace runstone {

/// Replaces the session's earlier request, if that is still waiting. A session's requests take effect
/// view_interval_us apart, as its views. A request for the past also waits until a worker has opened
/// it; kHistoriesOpeningMax are opened at a time.
void on_history_request(WorldState& world, SessionId session, const HistoryRequest& request,
                        const Clocks& now);
/// Carries out requests that had to wait. Call it on every tick.
void open_waiting_history(WorldState& world, const Clocks& now);
/// Handles the answer to WorldEnvironment::open_history(): the end of the view, or the reason of a
/// failure.
void on_history_opened(WorldState& world, SessionId session, std::uint32_t request,
                       const Result<OpenedHistory, std::string>& opened, const Clocks& now);
/// Handles the answer to WorldEnvironment::load_history_chunk(). `chunk` is null if it cannot be
/// read.
void on_history_chunk(WorldState& world, SessionId session, HistoryNumber history,
                      const ChunkKey& key, const ChunkPtr& chunk, const Clocks& now);

/// Loads the session's wanted chunks as they were, nearest first. The player pays for each
/// (pay_load()). Requires a history view.
void deliver_history(WorldState& world, SessionId session, const Clocks& now);
/// Forgets which chunks of the past the session has. Call it when the session's view changed,
/// because the client may have dropped chunks.
void forget_sent(WorldSession& session);

/// All sessions together. Each reads a part of the log.
inline constexpr std::size_t kHistoriesOpeningMax = 2;
inline constexpr std::size_t kHistoryChunksLoadingMax = 8;  // per session

}  // namespace runstone
