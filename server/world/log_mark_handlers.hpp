// Log mark handlers: answer the requests of clients for marks of the log. A reader reads them; the
// world strand adds the names of their authors. A session has one read under way, and its requests
// take effect view_interval_us apart, as its views and moments of the past. Who may not see the past
// may not see its authors either.
#pragma once
#include <string>
#include <vector>

#include "protocol/codec/log_mark_messages.hpp"
#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Replaces the session's earlier request, if that is still waiting.
void on_log_marks_request(WorldState& world, SessionId session, const LogMarksRequest& request,
                          const Clocks& now);
/// Carries out requests that had to wait. Call it on every tick.
void read_waiting_log_marks(WorldState& world, const Clocks& now);
/// Handles the answer to WorldEnvironment::read_log_marks(). The error is for the client.
void on_log_marks_read(WorldState& world, SessionId session, std::uint32_t request,
                       const Result<FoundLogMarks, std::string>& found, const Clocks& now);

/// All sessions together.
inline constexpr std::size_t kLogMarkReadsMax = 2;
/// A mark counts as so many bytes that were read from the session.
inline constexpr std::size_t kLogMarkBytes = 128;

}  // namespace runstone
