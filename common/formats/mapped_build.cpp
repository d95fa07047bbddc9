#include "common/formats/mapped_build.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/builds/build_transforms.hpp"
#include "common/core/assert.hpp"

namespace runstone {

Result<FileBuild> mapped_build(const FileBuild& build, const MaterialMap& map, AppliedRows& applied,
                               std::size_t bytes_max) {
  RUNSTONE_ASSERT(build.materials.size() == build.build->palette().size());
  using Key = std::pair<std::string, std::string>;  // name and states
  std::map<Key, BuildMaterial> chosen;
  std::vector<Key> keys;  // by palette entry
  std::vector<BuildMaterial> mapped;
  for (const BuildMaterial& material : build.materials) {
    auto row = map.apply(material, applied);
    if (!row) chosen.insert_or_assign(Key{material.row.name, material.states}, material);
    if (row) mapped.push_back({*row, ""});
    keys.push_back(row ? Key{row->name, ""} : Key{material.row.name, material.states});
  }
  for (BuildMaterial& material : mapped) {
    Key key{material.row.name, ""};
    chosen.try_emplace(std::move(key), std::move(material));
  }
  // Every material gets an id, ascending by name and states. That of every empty one is 0.
  std::map<Key, Material> ids;
  std::map<Material, const BuildMaterial*> by_id;
  Material next = kEmpty + 1;
  for (const auto& [key, material] : chosen) {
    const bool is_empty = material.row.visibility == Visibility::empty;
    const Material id = is_empty ? kEmpty : next++;
    ids.emplace(key, id);
    by_id.try_emplace(id, &material);
  }
  std::vector<std::optional<Material>> palette;
  for (const Key& key : keys) palette.emplace_back(ids.at(key));
  auto made = with_materials(*build.build, palette, bytes_max);
  if (!made) return failure(made.error());
  FileBuild out{build.info, *std::move(made), {}};
  for (const Material id : out.build->palette()) out.materials.push_back(*by_id.at(id));
  return out;
}

}  // namespace runstone
