#include "common/materials/veil_visibility.hpp"

#include "common/materials/foliage.hpp"

namespace runstone {

std::vector<Visibility> veil_visibilities(const MaterialTable& table) {
  std::vector<Visibility> out = cube_visibilities(table);
  for (std::size_t id = 0; id < out.size(); ++id) {
    const MaterialInfo& row = table[static_cast<Material>(id)];
    if (out[id] == Visibility::opaque && (row.body != MaterialBody::solid || is_foliage(row)))
      out[id] = Visibility::transparent;
  }
  return out;
}

}  // namespace runstone
