// Log lines of the net module that a peer can cause. Their rate is limited, so that no peer fills
// the disk.
#pragma once
#include <string>

#include "common/core/ids.hpp"
#include "common/core/result.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone {

// These functions may be called from any thread, and each of them writes at most as many lines as a
// LineThrottle passes in the whole process.

/// Writes one line for a connection whose TLS handshake failed.
void log_failed_handshake(SessionId session, const std::string& peer, const std::string& why);
/// Writes one warning for a connection of the gateway that was closed because of its PROXY header.
void log_refused_gateway(const std::string& why);
/// Writes one warning for a session that breaks a rule.
void log_broken_rule(SessionId session, const std::string& peer, GoodbyeReason reason,
                     const Error& error);

}  // namespace runstone
