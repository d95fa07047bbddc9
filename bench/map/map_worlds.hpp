// The worlds that `runstone-bench map` draws.
#pragma once
#include <cstdint>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// Sides of a square of stored terrain around the origin, in voxels.
inline constexpr std::int32_t kStoredSide = 1'088;

/// Makes a world whose terrain is stored as base chunks, with a log of synthetic edits of eight
/// builders that is a year long, and with keyframes. Returns the number of stored chunks.
Result<std::uint64_t, std::string> make_stored_world(const std::string& folder,
                                                     std::uint64_t edits);
/// Imports a Luanti world. Returns the box around its blocks.
Result<VoxelBox, std::string> make_luanti_world(const std::string& folder,
                                                const std::string& luanti);

}  // namespace runstone::bench
