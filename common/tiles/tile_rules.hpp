// Tile rules: the number of the rules by which tiles are made: build_tile(), veil(), and the coarse
// forms of the generators. A client keeps tiles over connections, and the number tells it whether they
// are still those of the server.
#pragma once
#include <cstdint>

namespace runstone {

/// Raise it with each change of the rules. A golden test pins tiles of it. Never 0.
inline constexpr std::uint32_t kTileRules = 1;

}  // namespace runstone
