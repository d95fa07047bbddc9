// Positions, chunk keys and versions as text for log lines, error messages and reports.
#pragma once
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"

namespace runstone {

/// Returns text such as "1 0 -3", the form that commands and scripts read.
std::string text_of(const VoxelPos& at);
/// Returns text such as "1,0,-3", or "1,0,-3 lod=2" if lod is not 0.
std::string text_of(const ChunkKey& key);
/// Returns epoch and sequence, such as "2:9120".
std::string text_of(const Version& version);

}  // namespace runstone
