// Materials of blocks that a file describes by colours or by names of its own: .vox, .qb, numpy, height
// maps.
#pragma once
#include "common/formats/format.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// Returns a solid material with the look of the block. A block with alpha below 255 is transparent. A
/// block without a look gets that of the material of its name in default_material_table(), otherwise a
/// colour from the hash of its name. The block "air" without a look is empty; a block "air" with one is
/// "air (solid)". A name that is no name of a material is changed, and then carries the hash of what it
/// was. The result is deterministic, and MaterialTable::add() accepts it for every block.
MaterialInfo material_of_look(const ForeignBlock& block, bool keep_all);

}  // namespace runstone
