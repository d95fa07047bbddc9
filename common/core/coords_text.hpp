// Positions and boxes as text, for options of programs.
#pragma once
#include <optional>
#include <string_view>

#include "common/core/coords.hpp"

namespace runstone {

/// Returns the position of "X,Y,Z": whole numbers in [-kWorldLimit, kWorldLimit) without blanks.
/// Returns nullopt for other text.
std::optional<VoxelPos> parse_voxel_pos(std::string_view text);

/// Returns the box of "X,Y,Z,X,Y,Z", two opposite corners that are both inside, as parse_voxel_pos()
/// reads a position. Returns nullopt for other text.
std::optional<VoxelBox> parse_voxel_box(std::string_view text);

}  // namespace runstone
