// Positions, chunk keys and versions as log lines, error messages and reports spell them.
#pragma once
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// "1 0 -3", as commands and scripts take it.
std::string text_of(const VoxelPos& at);
/// "1,0,-3", and "1,0,-3 lod=2" for chunks of less detail.
std::string text_of(const ChunkKey& key);
/// Epoch and sequence, "2:9120".
std::string text_of(const Version& version);

}  // namespace runstone
