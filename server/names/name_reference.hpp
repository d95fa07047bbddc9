// References: words that commands read as a player's number, fingerprint or key, as an address, as
// a role, or as a pattern of names. No player gets a name that reads as one, so that a command
// never means two things. A player who owns such a name from before keeps it, and commands refuse
// words that mean several.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace runstone {

/// The beginning of a word that names a role where a command takes a role or a player:
/// "role:mason".
inline constexpr std::string_view kRolePrefix = "role:";

/// Returns true if a word for players is a pattern of names: it contains a "*".
inline bool is_name_pattern(std::string_view word) {
  return word.find('*') != std::string_view::npos;
}

/// Returns the fingerprint in the form of key_fingerprint(), or an empty text if the word has not
/// the form of one.
std::string fingerprint_in(std::string_view word);

/// Returns how commands read this name, such as "the number of a player", or nullopt if they read
/// it as a name. Requires a folded name (folded_name). Cost: O(bytes).
std::optional<std::string> read_as_reference(std::string_view folded);

}  // namespace runstone
