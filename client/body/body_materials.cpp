#include "client/body/body_materials.hpp"

#include <utility>
#include <vector>

namespace runstone {

BodyMaterials body_materials(const MaterialTable& table) {
  std::vector<bool> solid, liquid;
  for (const MaterialInfo& row : table.rows()) {
    const bool is_there = row.visibility != Visibility::empty;
    solid.push_back(is_there && row.body == MaterialBody::solid);
    liquid.push_back(is_there && row.body == MaterialBody::liquid);
  }
  return {MaterialSet(std::move(solid), true), MaterialSet(std::move(liquid), false)};
}

}  // namespace runstone
