// The name that a person probably meant when the one that was typed does not exist. Pure.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace runstone {

/// Returns the name that becomes `typed` with the fewest typing mistakes, or an empty text if none
/// is near: more than a third of the letters, and more than one, are wrong. A mistake is a letter
/// that is missing, added or another one, or two neighbours in the wrong order. Upper and lower
/// case are the same. Cost: O(letters of `typed` * letters of all names).
std::string_view nearest_name(std::string_view typed, const std::vector<std::string>& names);

/// Returns "; did you mean NAME?" for an error message, or an empty text if no name is near.
std::string did_you_mean(std::string_view typed, const std::vector<std::string>& names);

}  // namespace runstone
