// Seeded worlds: landscapes and worst cases to measure meshers on, as formulas over columns. They
// are endless, with the ground near y = 0. They have the same voxels on every machine, since they
// use fixed hashes and + - * only.
//   hills         a height map in grass, dirt and stone
//   hills_plain   the same height map in stone alone
//   terrain       a rougher height map, with sand and water below y = 0
//   overhangs     3-D noise that thins out upwards: cliffs, arches, floating rock, in three
//                 materials
//   caves         winding tunnels in rock with pockets of ore
//   town          streets, houses with windows and roofs, gardens and trees (town.hpp)
//   noise         half of all voxels, at random
//   noise_mixed   the same in five materials, two of them transparent
//   sparse        one voxel in twenty
//   checkerboard  every other voxel
//   uniform       stone everywhere
//   empty         no voxels
#pragma once
#include <vector>

#include "bench/worlds/voxel_world.hpp"
#include "common/materials/material_table.hpp"

namespace runstone::bench {

/// Materials of seeded worlds.
enum class Block : Material {
  air,
  stone,
  dirt,
  grass,
  sand,
  water,
  glass,
  wood,
  brick,
  leaves,
  ore,
  tiles
};
constexpr Material id_of(Block block) { return static_cast<Material>(block); }

/// Returns the material table. Water and glass are transparent, the rest is opaque.
const MaterialTable& seeded_materials();

/// Returns all worlds, in the order above.
std::vector<VoxelWorld> seeded_worlds();

}  // namespace runstone::bench
