// ServerStatus: what the server says of itself at its status socket.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

struct ServerStatus {
  bool is_up = false;  // the server has answered
  std::string why;     // it has not
  std::map<std::string, std::int64_t> counters;
  std::vector<std::string> players;  // names, one for each session

  /// Returns a counter, or 0 if the server has none of this name.
  std::int64_t counter(const std::string& name) const;
};

/// Reads an answer of the status socket: lines that begin with "|", and "=ok" at the end. The lines
/// are "counters NAME=VALUE NAME=VALUE ..." and "player NAME". Values that are no whole numbers and
/// lines of other kinds are skipped, because a later server may have more of them.
Result<ServerStatus> parse_server_status(std::string_view answer);

}  // namespace runstone
