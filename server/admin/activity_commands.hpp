// The command `activity`: how much each player has built, as a table or as CSV.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "server/admin/command_row.hpp"
#include "server/admin/known_players.hpp"
#include "server/rollback/player_activity.hpp"

namespace runstone {

inline constexpr std::uint64_t kActivityLinesMax = 1'000;
struct ActivityCommand {
  std::string by;  // a player; empty: everybody
  std::optional<TimeUs> from_us, until_us;
  std::uint64_t limit = 20;
  bool is_csv = false;
  friend bool operator==(const ActivityCommand&, const ActivityCommand&) = default;
};

std::span<const CommandRow> activity_commands();

/// Returns the report as a table for people: a line with the names of the columns, one line for each
/// player, and what was left out. `present`: the authors who are here.
std::string activity_table(const ActivityReport& report, const KnownPlayers& players,
                           const std::set<AuthorId>& present);
/// Returns the report as CSV (RFC 4180, but with line feeds alone), with a line of column names.
/// Times are UTC. A name that a spreadsheet might take for a formula has an apostrophe before it.
std::string activity_csv(const ActivityReport& report, const KnownPlayers& players,
                         const std::set<AuthorId>& present);

}  // namespace runstone
