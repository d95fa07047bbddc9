// Failure words: the reason why a player is not on a server, in words for the player. The detail
// has the exact text of the server or of the system. Pure.
#pragma once
#include <string>
#include <string_view>

#include "client/session/server_connection.hpp"

namespace runstone {

struct FailureWords {
  std::string headline;  // a sentence without a full stop
  std::string detail;    // the exact reason; may be empty
  friend bool operator==(const FailureWords&, const FailureWords&) = default;
};

/// Returns the words for the end of a session.
FailureWords words_of(const SessionEnd& end);
/// Returns the words for a connection to `address` that could not be made or was lost. `why` is the
/// text of LinkDisconnected.
FailureWords words_of_link(std::string_view why, const std::string& address);

}  // namespace runstone
