// Siege flags: the settings that a server needs for a crowd from one address, and the length of a
// window.
#pragma once
#include <string>
#include <vector>

namespace runstone::bench {

inline constexpr double kSiegeWindowSeconds = 10;

/// Returns the flags of the server in addition to its default settings: no more than `bots` honest
/// clients from one address need. Hostile clients get the same limits.
std::vector<std::string> siege_flags(unsigned bots);

}  // namespace runstone::bench
