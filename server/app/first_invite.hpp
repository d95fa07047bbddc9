// First invite: the link with which the first administrator of a world joins.
#pragma once
#include <string>

#include "server/app/server.hpp"

namespace runstone {

/// Makes an invite of the role administrator with one use, for 24 hours. Returns lines for the
/// person who has started the server, or why there is no invite. Requires a server that runs.
/// Blocks until the world strand has answered.
std::string make_first_invite(Server& server);

/// Returns true if this descriptor goes to the journal of systemd, which keeps what is written.
bool is_journal(int descriptor);

}  // namespace runstone
