// The answer of the command `chat log`.
#pragma once
#include <string>
#include <vector>

#include "server/world/environment/chat_entry.hpp"

namespace runstone {

/// Returns a line for each entry: the time, the name and the fingerprint of the player, and the text.
std::string chat_list(const std::vector<ChatEntry>& entries);

}  // namespace runstone
