#include "common/formats/named_build.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/builds/build_transforms.hpp"
#include "common/core/assert.hpp"

namespace runstone {

Result<FileBuild> named_build(const BuildInfo& info, const Build& build,
                              std::vector<BuildMaterial> materials, std::size_t bytes_max) {
  RUNSTONE_ASSERT(materials.size() == build.palette().size());
  using Key = std::pair<std::string, std::string>;  // name and states
  std::map<Key, const BuildMaterial*> named;
  for (const BuildMaterial& material : materials)
    named.try_emplace(Key{material.row.name, material.states}, &material);
  // Every material gets an id, ascending by name and states. That of every empty one is 0.
  std::map<Key, Material> ids;
  std::map<Material, const BuildMaterial*> by_id;
  Material next = kEmpty + 1;
  for (const auto& [key, material] : named) {
    const bool is_empty = material->row.visibility == Visibility::empty;
    const Material id = is_empty ? kEmpty : next++;
    ids.emplace(key, id);
    by_id.try_emplace(id, material);
  }
  std::vector<std::optional<Material>> palette;
  for (const BuildMaterial& material : materials)
    palette.emplace_back(ids.at(Key{material.row.name, material.states}));
  auto made = with_materials(build, palette, bytes_max, PaletteOrder::ascending);
  if (!made) return failure(made.error());
  FileBuild out{info, *std::move(made), {}};
  for (const Material id : out.build->palette()) out.materials.push_back(*by_id.at(id));
  return out;
}

}  // namespace runstone
