// Checks of what a player types or receives in order to join. The encoder requires that they pass.
// Pure.
#pragma once
#include <string>
#include <string_view>

#include "common/core/result.hpp"

namespace runstone {

/// Fails with words for the player unless the name has 1 to kPlayerNameBytesMax bytes and is
/// is_plain_name().
Result<void, std::string> check_player_name(std::string_view name);

/// Fails with words for the player unless the ticket is empty, which means that there is none, or
/// has kTicketBytesMax bytes at most and is printable.
Result<void, std::string> check_ticket(std::string_view ticket);

}  // namespace runstone
