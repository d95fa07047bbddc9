// ServerStatus: what the server says of itself at its status socket.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// Where a player is.
struct PlayerPlace {
  std::string name;
  double x = 0, y = 0, z = 0;
};

/// The border of the world, as columns.
struct StatusBorder {
  bool is_circle = false;
  /// The numbers of a box are x and z of the first column and of the column behind the last. The
  /// numbers of a circle are x and z of the column in the middle, the radius, and 0.
  std::array<std::int64_t, 4> numbers{};
};

struct ServerStatus {
  bool is_up = false;     // the server has answered
  std::string why;        // it has not
  std::string version;    // of the server; empty: it is an older one, which does not say it
  std::string read_only;  // why edits are refused; empty: they are taken
  std::map<std::string, std::int64_t> counters;
  std::vector<std::string> players;    // names, one for each session
  std::vector<PlayerPlace> places;     // of the same players, empty if the server sends no places
  std::optional<StatusBorder> border;  // nullopt: the world has none, or the server does not say it

  /// Returns a counter, or 0 if the server has none of this name.
  std::int64_t counter(const std::string& name) const;
};

/// One of the worlds of a gateway.
struct WorldStatus {
  std::string_view name;  // empty: the only one
  std::string_view title;
  std::shared_ptr<const ServerStatus> status;  // null: nobody asked for it
};

/// How many edits waited at most so long on the server.
struct EditWaits {
  std::uint64_t ms_max = 0, count = 0;
};
/// Returns the counters NAME_ms_le_N of a status, by N.
std::vector<EditWaits> edit_waits(const ServerStatus& status, std::string_view name);

/// Reads an answer of the status socket: lines that begin with "|", and "=ok" at the end. The lines
/// are "counters NAME=VALUE NAME=VALUE ...", "version TEXT", "read_only WHY", "player NAME",
/// "place X Y Z NAME", and "border box X Z X Z" or "border circle X Z RADIUS".
/// Values that are no whole numbers and lines of other kinds are skipped, because a later server may
/// have more of them.
Result<ServerStatus> parse_server_status(std::string_view answer);

}  // namespace runstone
