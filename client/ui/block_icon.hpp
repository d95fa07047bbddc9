// The icon of a material in hotbar and palette: a small block with the colour, pattern, gloss and
// glow of the material. Only sources of client/ui include this file.
#pragma once
#include <imgui.h>

#include "common/materials/material_table.hpp"

namespace runstone {

/// Draws the block into the rectangle. A transparent material shows a light ground through it, and
/// a material that gives off light has a halo. Cost: at most about 40 shapes.
void block_icon(ImDrawList& list, ImVec2 from, ImVec2 to, const MaterialInfo& material);

}  // namespace runstone
