// From the filter of a command to the filter of the log: players are looked up, patterns of names
// and groups of players become author numbers.
#pragma once
#include <cstddef>
#include <functional>
#include <string>

#include "server/admin/command_call.hpp"
#include "server/admin/rollback_commands.hpp"
#include "server/rollback/selection.hpp"

namespace runstone {

/// A pattern that selects more players than this, or everybody who has built, must be confirmed
/// where `must_confirm` is set.
inline constexpr std::size_t kPatternPlayersMax = 64;
/// An `address-of` that selects more players than this, or everybody who has built, must be
/// confirmed there, too. So many players who share an address are hardly one person: they come
/// through a proxy, a provider or a school. It is below the players that are kept of an address
/// (PlayerAddresses).
inline constexpr std::size_t kSharedPlayersMax = 16;

/// Calls `go_on` with the filter for the log. Players are looked up on a worker, as in all commands.
/// Reports whom a pattern or `address-of` selects. Refuses the command, with a text that begins with
/// `command`, if
///   - a player is unknown or ambiguous, or has never built;
///   - the words about players leave nobody;
///   - a pattern or `address-of` selects too many players, or `joined-after` everybody, and the line
///     did not end with kAnyway. `must_confirm`: for a command that prepares a change.
void with_selection(const CommandCall& call, const CommandFilter& filter,
                    const std::string& command, bool must_confirm,
                    const std::function<void(const SelectionFilter&)>& go_on);

}  // namespace runstone
