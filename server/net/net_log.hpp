// Log lines of the net module that a peer can cause. Their rate is limited, so that no peer fills
// the disk.
#pragma once
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

/// Writes one warning for a session that breaks a rule, at most as many as LineThrottle passes in
/// the whole process.
/// Thread: any.
void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error);

}  // namespace runstone
