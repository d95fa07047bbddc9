#include "common/materials/veil_visibility.hpp"

namespace runstone {

std::vector<Visibility> veil_visibilities(const MaterialTable& table) {
  std::vector<Visibility> out = cube_visibilities(table);
  for (std::size_t id = 0; id < out.size(); ++id) {
    if (out[id] == Visibility::opaque &&
        table[static_cast<Material>(id)].body != MaterialBody::solid)
      out[id] = Visibility::transparent;
  }
  return out;
}

}  // namespace runstone
