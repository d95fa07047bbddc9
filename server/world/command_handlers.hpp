// Command steps: a client's command on its way through the world strand. Who carries it out stands behind the
// ports; here it is made sure that a client has one command under way, and not too many a second.
#pragma once
#include <string>
#include <vector>

#include "server/world/clocks.hpp"
#include "server/world/world_state.hpp"

namespace runstone {

void on_command(WorldState& world, SessionId session, const CommandRequest& request,
                const Clocks& now);

/// Output of the session's command under way; the last one is done. Nothing if the session is gone or has none.
void send_command_output(WorldState& world, SessionId session,
                         const std::vector<std::string>& lines, bool is_done, bool is_ok);

}  // namespace runstone
