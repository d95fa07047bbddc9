// Reserved names: nobody may have them, because people would take what such a player says for the
// word of the server or of its host.
#pragma once
#include <array>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"

namespace runstone {

/// The names that are reserved on every server.
inline constexpr std::array<const char*, 22> kReservedNames = {
    "admin",           "administrator", "all",   "anybody", "console", "everybody",
    "everyone",        "here",          "host",  "me",      "mod",     "moderator",
    "nobody",          "operator",      "op",    "owner",   "root",    "runstone",
    "runstone server", "server",        "staff", "system"};

/// Parses names that are separated by commas. An empty text has none. Fails if one is no
/// is_plain_name().
Result<std::vector<std::string>, std::string> parse_reserved_names(std::string_view text);

/// Returns the folded forms of kReservedNames and of `more`.
std::set<std::string> folded_reserved_names(const std::vector<std::string>& more);

}  // namespace runstone
