// PlayerLog: log lines about the players who come and go, with the fingerprints of their keys. A
// name can be imitated, a fingerprint cannot.
#pragma once
#include <cstddef>
#include <map>
#include <string>

#include "client/session/client_session.hpp"

namespace runstone {

/// While more players are present, nothing is logged, because the log would become too long.
inline constexpr std::size_t kPlayersLoggedMax = 64;

class PlayerLog {
 public:
  /// Logs the differences from the last call. Cost: O(players).
  void update(const std::map<AuthorId, OtherPlayer>& others);

 private:
  std::map<AuthorId, std::string> logged_;  // name and fingerprint
};

}  // namespace runstone
