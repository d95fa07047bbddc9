// Command handlers: accept a client's command and send its output. WorldEnvironment carries it out.
// A client has at most one command under way and may give kCommandsPerSecond a second.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Carries out the command, or rejects it with a line of output.
void on_command(WorldState& world, SessionId session, const CommandRequest& request,
                const Clocks& now);

/// Returns the view in which a session shows the changes of a rollback before it is applied, or
/// nullopt if there is no such session, it has no view, or its client cannot show them.
std::optional<View> restore_preview_view(const WorldState& world, SessionId session);
/// Sends what a rollback would change, for the session's command under way. Does nothing if there is
/// none, or if the client cannot show it. If the session's queue is full, the client gets the text
/// of the answer alone.
void send_restore_preview(WorldState& world, SessionId session, RestorePreview preview);

/// Sends output of the session's command under way. `is_done` ends the command. Does nothing if the
/// session is closed or has no command under way.
void send_command_output(WorldState& world, SessionId session,
                         const std::vector<std::string>& lines, bool is_done, bool is_ok);

}  // namespace runstone
