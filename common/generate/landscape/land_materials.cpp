#include "common/generate/landscape/land_materials.hpp"

#include <utility>

namespace runstone {

Result<LandMaterials> LandMaterials::find(const MaterialTable& table) {
  LandMaterials out{};
  const std::pair<const char*, Material*> names[] = {
      {"grass", &out.grass},
      {"forest_floor", &out.forest_floor},
      {"dirt", &out.dirt},
      {"stone", &out.stone},
      {"sand", &out.sand},
      {"gravel", &out.gravel},
      {"clay", &out.clay},
      {"snow", &out.snow},
      {"water", &out.water},
      {"log", &out.log},
      {"leaves", &out.leaves},
      {"birch_log", &out.birch_log},
      {"birch_leaves", &out.birch_leaves},
      {"pine_leaves", &out.pine_leaves},
      {"tall_grass", &out.tall_grass},
      {"fern", &out.fern},
      {"bush", &out.bush},
      {"reeds", &out.reeds},
      {"poppy", &out.poppy},
      {"dandelion", &out.dandelion},
      {"cornflower", &out.cornflower},
  };
  for (const auto& [name, material] : names) {
    const auto id = table.find(name);
    if (!id) {
      return fail(
          ErrorCode::not_found,
          "the table lacks a material of landscape (docs/worlds.md lists them); the built-in "
          "table has all of them");
    }
    *material = *id;
  }
  return out;
}

}  // namespace runstone
