// Placed material: the member of a family that a click means. Stairs ascend away from the player, a
// slab lies in the half that was clicked, a log points out of the face, a torch hangs on the wall.
// Pure.
#pragma once
#include "client/tools/aim.hpp"
#include "common/core/coords.hpp"
#include "common/core/ids.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {

/// The facts of a click that turn a material.
struct PlacedClick {
  Direction face = Direction::pos_y;  // of the voxel that was clicked
  double height = 0;                  // of the place that was hit in that voxel, 0 .. 1
  LookDirection look;
};

/// Returns the click of an aim. A hit without a distance, as a script's aim has it, is in the
/// middle of its face. Requires a hit with a face.
PlacedClick click_of(const Aim& aim);

/// Returns the member of the held material's family, or of that which hangs on walls (torch and
/// wall_torch, signs, banners, heads), that a click places. Of the members that the table has, the
/// one with the fewest states that differ from those that the click means; of equal ones the held
/// one. States that a click does not choose stay those of the held material. A material whose
/// family has no such states is returned. docs/client.md says which states a click chooses. Cost:
/// O(rules), and that of the family if the table lacks the exact member.
Material placed_material(Material held, const PlacedClick& click, const MaterialTable& table);

}  // namespace runstone
