// Command handlers: accept a client's command and send its output. WorldEnvironment carries it out.
// A client has at most one command under way and may give kCommandsPerSecond a second.
#pragma once
#include <string>
#include <vector>

#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

/// Carries out the command, or rejects it with a line of output.
void on_command(WorldState& world, SessionId session, const CommandRequest& request,
                const Clocks& now);

/// Sends output of the session's command under way. `is_done` ends the command. Does nothing if the
/// session is closed or has no command under way.
void send_command_output(WorldState& world, SessionId session,
                         const std::vector<std::string>& lines, bool is_done, bool is_ok);

}  // namespace runstone
