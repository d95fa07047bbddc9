// Blocks for the colours of a .vox, and colours for blocks. Internal to .vox.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "common/core/material_look.hpp"
#include "common/core/material_row.hpp"
#include "common/formats/format.hpp"
#include "common/formats/vox_file.hpp"

namespace runstone {

/// Returns the blocks of the colours 1 .. 255. read_vox() says how they are named.
std::vector<ForeignBlock> vox_blocks(const VoxFile& file);

/// Returns the value of an entry `_runstone_look`: the shares of a look and its pattern as numbers.
std::string vox_look_text(const MaterialLook& look);

/// Returns "#rrggbb", and "aa" behind it if it is not 255.
std::string vox_colour_text(const MaterialColour& colour);

}  // namespace runstone
