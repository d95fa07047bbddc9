// Log lines of the net module that a peer can trigger: rate-limited, so that nobody fills the disk.
#pragma once
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// One warning per broken session, ten a second at most in the whole process; the next line says how many
/// were left out.
void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error);

}  // namespace runstone
